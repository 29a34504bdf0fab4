#include "apps/reproduce/result_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "apps/reproduce/csv_field.h"
#include "coupling/errors.h"

namespace spume::apps {
namespace {

constexpr char kHeader[] =
    "study,title,resolution,quantity,figure,unit,reference,source,aim,verdict,seconds,note";
constexpr std::size_t kFields = 12;
constexpr const char* kVerdicts[] = {"met", "missed", "-"};
constexpr const char* kAnswers[] = {"yes", "**no**", "-"};

/// Four significant digits: what a person compares. The CSV holds all of them.
std::string shortText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string exactText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string withUnit(const std::string& value, const std::string& unit) {
  return unit.empty() ? value : value + " " + unit;
}

ResultRow rowOf(const std::vector<std::string>& f) {
  ResultRow row{f[0], f[1], f[2], f[3], std::strtod(f[4].c_str(), nullptr), f[5], f[6], f[7], f[8]};
  for (const Verdict verdict : {Verdict::met, Verdict::missed})
    if (f[9] == kVerdicts[static_cast<int>(verdict)]) row.verdict = verdict;
  row.seconds = std::strtod(f[10].c_str(), nullptr);
  row.note = f[11];
  return row;
}

}  // namespace

ResultRow& aimAtMost(ResultRow& row, double figure, double limit, const std::string& unit) {
  row.figure = figure;
  row.unit = unit;
  row.aim = "<= ";
  row.aim += withUnit(shortText(limit), unit);
  row.verdict = std::abs(figure) <= limit ? Verdict::met : Verdict::missed;  // NaN misses
  return row;
}

ResultRow& aimAtLeast(ResultRow& row, double figure, double limit, const std::string& unit) {
  aimAtMost(row, figure, limit, unit);
  row.aim.replace(0, 2, ">=");
  row.verdict = figure >= limit ? Verdict::met : Verdict::missed;  // NaN misses
  return row;
}

ResultRow& aimWithin(ResultRow& row, double figure, double low, double high, const std::string& unit) {
  row.figure = figure;
  row.unit = unit;
  row.aim = withUnit(shortText(low) + " to " + shortText(high), unit);
  row.verdict = figure >= low && figure <= high ? Verdict::met : Verdict::missed;  // NaN misses
  return row;
}

ResultRow& reportOnly(ResultRow& row, double figure, const std::string& unit) {
  row.figure = figure;
  row.unit = unit;
  return row;
}

void ResultTable::set(const std::string& study, const std::vector<ResultRow>& rows) {
  const auto isOld = [&](const ResultRow& row) { return row.study == study; };
  const auto first = std::find_if(rows_.begin(), rows_.end(), isOld);
  const auto place = first - rows_.begin();
  rows_.erase(std::remove_if(first, rows_.end(), isOld), rows_.end());
  rows_.insert(rows_.begin() + place, rows.begin(), rows.end());
}

void ResultTable::order(const std::vector<std::string>& studies) {
  const auto place = [&](const ResultRow& row) {
    return std::find(studies.begin(), studies.end(), row.study);
  };
  std::stable_sort(rows_.begin(), rows_.end(),
                   [&](const ResultRow& a, const ResultRow& b) { return place(a) < place(b); });
}

int ResultTable::count(Verdict verdict) const {
  return static_cast<int>(std::count_if(rows_.begin(), rows_.end(),
                                        [&](const ResultRow& row) { return row.verdict == verdict; }));
}

std::string ResultTable::csv() const {
  std::string text = std::string(kHeader) + "\n";
  for (const ResultRow& r : rows_) {
    const std::string cells[kFields] = {r.study,
                                        r.title,
                                        r.resolution,
                                        r.quantity,
                                        exactText(r.figure),
                                        r.unit,
                                        r.reference,
                                        r.source,
                                        r.aim,
                                        kVerdicts[static_cast<int>(r.verdict)],
                                        shortText(r.seconds),
                                        r.note};
    for (std::size_t n = 0; n < kFields; ++n) text.append(n ? "," : "").append(csvField(cells[n]));
    text += "\n";
  }
  return text;
}

std::string ResultTable::markdown() const {
  std::ostringstream text;
  text << "# " << title_ << "\n\n| case | resolution | figure | ours | reference | aim | met | s |\n"
       << "|---|---|---|---|---|---|---|---|\n";
  for (const ResultRow& r : rows_) {
    text << "| " << r.study << ' ' << r.title << " | " << r.resolution << " | " << r.quantity;
    if (!r.note.empty()) text << " (" << r.note << ')';
    text << " | " << withUnit(shortText(r.figure), r.unit) << " | " << r.reference;
    if (!r.source.empty()) text << " [" << r.source << ']';
    text << " | " << (r.aim.empty() ? "report" : r.aim) << " | " << kAnswers[static_cast<int>(r.verdict)]
         << " | " << shortText(r.seconds) << " |\n";
  }
  text << '\n' << count(Verdict::met) << " aims met, " << count(Verdict::missed) << " missed.\n";
  return text.str();
}

void ResultTable::readCsv(const std::string& text, const std::string& path) {
  std::size_t start = 0;
  int number = 0;
  for (std::size_t end; (end = text.find('\n', start)) != std::string::npos; start = end + 1) {
    const std::string line = text.substr(start, end - start);
    if (number++ == 0) {
      if (line != kHeader) throw coupling::SceneError(path + ": is not a table of results");
      continue;
    }
    const std::vector<std::string> fields = csvFields(line);
    if (fields.size() != kFields)
      throw coupling::SceneError(path + ":" + std::to_string(number) + ": " + std::to_string(fields.size()) +
                                 " fields, expected " + std::to_string(kFields));
    rows_.push_back(rowOf(fields));
  }
}

std::string summaryOf(const ResultRow& row) {
  std::ostringstream text;
  text << row.study << ' ' << row.title << ", " << row.resolution << ": " << row.quantity << ' '
       << withUnit(shortText(row.figure), row.unit);
  if (!row.aim.empty()) text << " (" << row.aim << ": " << kVerdicts[static_cast<int>(row.verdict)] << ')';
  return text.str();
}

}  // namespace spume::apps
