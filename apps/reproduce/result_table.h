#pragma once

#include <string>
#include <vector>

namespace spume::apps {

/// Whether a figure reached what it aims at.
enum class Verdict { met, missed, none };

/// One figure of a validation table.
struct ResultRow {
  std::string study = {};       ///< key of the case it belongs to: "L3"
  std::string title = {};       ///< "single vortex"
  std::string resolution = {};  ///< "128^2, 16 markers a cell"
  std::string quantity = {};    ///< "area change"
  double figure = 0;            ///< ours
  std::string unit = {};        ///< of the figure
  std::string reference = {};   ///< the published or exact figure, with its unit
  std::string source = {};      ///< where that comes from
  std::string aim = {};         ///< "<= 0.5 %"; empty: reported only
  Verdict verdict = Verdict::none;
  double seconds = 0;     ///< wall time of the case, on the machine of the run
  std::string note = {};  ///< settings that differ from the defaults, or why an aim is missed

  bool operator==(const ResultRow&) const = default;
};

/// Sets figure, unit, aim and verdict: |figure| is to be at most `limit`, in the same unit.
ResultRow& aimAtMost(ResultRow& row, double figure, double limit, const std::string& unit);

/// The same where the figure is to be at least `limit`.
ResultRow& aimAtLeast(ResultRow& row, double figure, double limit, const std::string& unit);

/// The same where the figure is to lie between two limits.
ResultRow& aimWithin(ResultRow& row, double figure, double low, double high, const std::string& unit);

/// Sets figure and unit of a row that aims at nothing.
ResultRow& reportOnly(ResultRow& row, double figure, const std::string& unit);

/// A validation table: rows in the order of their studies.
class ResultTable {
 public:
  /// `title` heads the Markdown form.
  explicit ResultTable(std::string title) : title_(std::move(title)) {}

  /// Replaces the rows of a study, or appends them if it has none yet.
  void set(const std::string& study, const std::vector<ResultRow>& rows);
  /// Brings the studies into the order of `studies`; those not named come last, as they were.
  void order(const std::vector<std::string>& studies);
  const std::vector<ResultRow>& rows() const { return rows_; }
  int count(Verdict verdict) const;

  std::string csv() const;
  std::string markdown() const;
  /// Adds the rows of a text that csv() wrote; `path` is for messages. Throws coupling::SceneError.
  void readCsv(const std::string& text, const std::string& path);

 private:
  std::string title_;
  std::vector<ResultRow> rows_;
};

/// One line for a terminal: study, quantity, figure, aim, verdict.
std::string summaryOf(const ResultRow& row);

}  // namespace spume::apps
