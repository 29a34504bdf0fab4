#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "coupling/atomic_file.h"
#include "coupling/cell_table.h"
#include "coupling/csv_writer.h"
#include "tests/support/temporary_path.h"

namespace spume::coupling {
namespace {

/// A file that vanishes with the test.
struct TemporaryTable {
  std::string path;
  explicit TemporaryTable(const std::string& name) : path(temporaryPath(name)) {}
  ~TemporaryTable() { std::remove(path.c_str()); }
  std::string contents() const { return readFile(path); }
};

/// Three bubbles in a row whose ids run against their order; the first and the last do not touch.
struct Chain {
  BubbleTable bubbles;
  foam::FoamTopology topology;

  Chain() {
    bubbles.resize(3);
    bubbles.id = {12, 11, 10};
    topology.volume = {.5, 0.1, 0};
    topology.freeArea = {2, 1e-9, 0};
    topology.filmArea = {.25, .375, .125};
    topology.hidden = {0, 0, 1};
    topology.films = {{0, 1, 1.5, .75, .25}, {1, 2, 1.0 / 3, .1, .125}};
  }
};

TEST(CellTable, CellsAreWrittenInTheOrderOfTheTable) {
  const TemporaryTable file("cells.csv");
  const Chain chain;
  writeCellTable(file.path, chain.bubbles, chain.topology);
  EXPECT_EQ(file.contents(),
            "id,volume,free_area,film_area,films,hidden\n"
            "12,0.5,2,0.25,1,0\n"
            "11,0.10000000000000001,1.0000000000000001e-09,0.375,2,0\n"
            "10,0,0,0.125,1,1\n");
}

TEST(CellTable, ContactsAreOrderedByIds) {
  const TemporaryTable file("contacts.csv");
  const Chain chain;
  writeContactTable(file.path, chain.bubbles, chain.topology);
  EXPECT_EQ(file.contents(),
            "id_a,id_b,distance,film_area\n"
            "10,11,0.33333333333333331,0.125\n"
            "11,12,1.5,0.25\n");
}

TEST(CellTable, TotalsCountEveryFilmOnce) {
  const FoamTotals totals = totalsOf(Chain().topology);
  EXPECT_EQ(totals.bubbles, 3u);
  EXPECT_EQ(totals.hidden, 1u);
  EXPECT_EQ(totals.contacts, 2u);
  EXPECT_EQ(totals.volume, .5 + .1);
  EXPECT_EQ(totals.freeArea, 2 + 1e-9);
  EXPECT_EQ(totals.filmArea, .375);
}

TEST(CellTable, NoBubblesLeaveTheHeader) {
  const TemporaryTable file("none.csv");
  writeCellTable(file.path, {}, {});
  EXPECT_EQ(file.contents(), "id,volume,free_area,film_area,films,hidden\n");
}

TEST(CellTable, UnwritablePathIsNamed) {
  try {
    writeCellTable("/nonexistent/cells.csv", {}, {});
    FAIL() << "was written";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("/nonexistent/cells.csv: "), std::string::npos) << error.what();
  }
}

/// Many blocks of rows, of lengths that differ, read back as the same doubles in the same order.
TEST(CsvWriter, RowsStayInOrderForAnyNumberOfThreads) {
  constexpr std::size_t kRows = 100000;
  const auto value = [](std::size_t row) { return 1.0 / static_cast<double>(1 + row * row); };
  const auto fill = [&](std::size_t row, CsvRow& out) {
    out.integer(row);
    out.number(value(row));
  };
  const TemporaryTable one("one.csv"), many("many.csv");
  {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    writeCsv(one.path, "row,value", kRows, fill);
  }
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 4);
  writeCsv(many.path, "row,value", kRows, fill);
  const std::string text = many.contents();
  EXPECT_EQ(text, one.contents());
  const char* at = text.c_str() + text.find('\n') + 1;
  for (std::size_t row = 0; row < kRows; ++row) {
    char* end = nullptr;
    ASSERT_EQ(std::strtoull(at, &end, 10), row);
    ASSERT_EQ(std::strtod(end + 1, &end), value(row));
    at = end + 1;
  }
  EXPECT_EQ(*at, '\0');
}

}  // namespace
}  // namespace spume::coupling
