#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace spume::coupling {

/// A row of comma-separated values being put together.
class CsvRow {
 public:
  /// Appends to `text`, which must outlive the object.
  explicit CsvRow(std::string& text) : text_(text), start_(text.size()) {}

  void integer(std::uint64_t value);
  /// 17 significant digits: reads back as the same double.
  void number(double value);

 private:
  void append(const char* begin, const char* end);

  std::string& text_;
  std::size_t start_;
};

/// Writes a header and `rows` rows, formatted on all threads and written in order. Holds a bounded part of
/// the text in memory. `fillRow` is called concurrently. Atomic. Throws FileError.
void writeCsv(const std::string& path, const std::string& header, std::size_t rows,
              const std::function<void(std::size_t row, CsvRow& out)>& fillRow);

}  // namespace spume::coupling
