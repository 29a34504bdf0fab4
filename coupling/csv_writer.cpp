#include "coupling/csv_writer.h"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>

#include "coupling/atomic_file.h"

namespace spume::coupling {
namespace {

constexpr std::size_t kRowsPerBlock = 8192;  ///< about half a megabyte of text
constexpr int kSignificantDigits = 17;       ///< the fewest that tell any two doubles apart

using FillRow = std::function<void(std::size_t row, CsvRow& out)>;

std::string blockOfRows(std::size_t begin, std::size_t end, const FillRow& fillRow) {
  std::string text;
  for (std::size_t row = begin; row < end; ++row) {
    CsvRow out(text);
    fillRow(row, out);
    text += '\n';
  }
  return text;
}

/// Blocks are handed out and written in order, and formatted in between.
void streamRows(std::ostream& file, std::size_t rows, const FillRow& fillRow) {
  std::size_t next = 0;
  const auto handOut = [&](tbb::flow_control& control) {
    if (next >= rows || !file) control.stop();
    return std::exchange(next, next + kRowsPerBlock);
  };
  const auto format = [&](std::size_t begin) {
    return blockOfRows(begin, std::min(rows, begin + kRowsPerBlock), fillRow);
  };
  const auto write = [&](const std::string& text) {
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
  };
  const std::size_t blocksInFlight = 4 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  tbb::parallel_pipeline(blocksInFlight,
                         tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, handOut) &
                             tbb::make_filter<std::size_t, std::string>(tbb::filter_mode::parallel, format) &
                             tbb::make_filter<std::string, void>(tbb::filter_mode::serial_in_order, write));
}

}  // namespace

void CsvRow::integer(std::uint64_t value) {
  char digits[24];
  append(digits, std::to_chars(digits, std::end(digits), value).ptr);
}

void CsvRow::number(double value) {
  char digits[32];
  append(digits,
         std::to_chars(digits, std::end(digits), value, std::chars_format::general, kSignificantDigits).ptr);
}

void CsvRow::append(const char* begin, const char* end) {
  if (text_.size() > start_) text_ += ',';
  text_.append(begin, end);
}

void writeCsv(const std::string& path, const std::string& header, std::size_t rows, const FillRow& fillRow) {
  replaceFile(path, [&](const std::string& temporary) {
    errno = 0;
    std::ofstream file(temporary, std::ios::binary);
    file << header << '\n';
    streamRows(file, rows, fillRow);
    file.close();
    if (!file) throw FileError(path + ": cannot write: " + std::strerror(errno ? errno : EIO));
  });
}

}  // namespace spume::coupling
