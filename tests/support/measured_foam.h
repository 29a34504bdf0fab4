#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/apps_program.h"
#include "tests/support/foam_balls.h"

namespace spume::apps::test {

using foam::test::Balls;

inline std::string csvOf(const Balls& balls) {
  std::string text = "id,x,y,z,r\n";
  char row[160];
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Eigen::Vector3d& x = balls.position[i];
    std::snprintf(row, sizeof row, "%lu,%.17g,%.17g,%.17g,%.17g\n", static_cast<unsigned long>(balls.id[i]),
                  x.x(), x.y(), x.z(), balls.radius[i]);
    text += row;
  }
  return text;
}

struct CellRow {
  std::uint64_t id;
  double volume, freeArea, filmArea;
  int films, hidden;
};

struct ContactRow {
  std::uint64_t a, b;
  double distance, filmArea;
};

/// What `spume measure` wrote about some balls.
struct MeasuredFoam {
  std::vector<CellRow> cells;
  std::vector<ContactRow> contacts;
  std::string cellText, contactText;
};

/// The lines of a table behind its header.
inline std::istringstream rowsOf(const std::string& text) {
  return std::istringstream(text.substr(text.find('\n') + 1));
}

inline std::vector<CellRow> cellRows(const std::string& text) {
  std::vector<CellRow> rows;
  std::istringstream lines = rowsOf(text);
  for (std::string line; std::getline(lines, line);) {
    char* at = line.data();
    CellRow row{};
    row.id = std::strtoull(at, &at, 10);
    for (double* value : {&row.volume, &row.freeArea, &row.filmArea}) *value = std::strtod(at + 1, &at);
    for (int* value : {&row.films, &row.hidden}) *value = static_cast<int>(std::strtol(at + 1, &at, 10));
    rows.push_back(row);
  }
  return rows;
}

inline std::vector<ContactRow> contactRows(const std::string& text) {
  std::vector<ContactRow> rows;
  std::istringstream lines = rowsOf(text);
  for (std::string line; std::getline(lines, line);) {
    char* at = line.data();
    ContactRow row{};
    row.a = std::strtoull(at, &at, 10);
    row.b = std::strtoull(at + 1, &at, 10);
    for (double* value : {&row.distance, &row.filmArea}) *value = std::strtod(at + 1, &at);
    rows.push_back(row);
  }
  return rows;
}

/// Measures balls through the program.
inline MeasuredFoam measured(const Balls& balls, const std::string& options = {}) {
  const Scratch scratch;
  const std::string input = scratch.write("balls.csv", csvOf(balls));
  const std::string cells = scratch / "cells.csv", contacts = scratch / "contacts.csv";
  const Outcome outcome =
      runSpume("measure " + input + " -o " + cells + " --contacts " + contacts + " " + options);
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  MeasuredFoam foam;
  foam.cellText = contentsOf(cells), foam.contactText = contentsOf(contacts);
  foam.cells = cellRows(foam.cellText), foam.contacts = contactRows(foam.contactText);
  return foam;
}

}  // namespace spume::apps::test
