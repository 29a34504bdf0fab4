#pragma once

#include <string>
#include <vector>

namespace spume::apps {

/// Named values for a person or, as one flat JSON object, for a program.
class Report {
 public:
  /// Shown so that it reads back exactly. `unit` is shown to persons; for programs it belongs in the key.
  void add(const std::string& key, double value, const std::string& unit = {});
  void add(const std::string& key, const std::string& value);

  std::string text() const;
  std::string json() const;

 private:
  struct Row {
    std::string key, value, unit;
    bool quoted;
  };
  std::vector<Row> rows_;
};

}  // namespace spume::apps
