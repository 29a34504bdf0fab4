#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "coupling/errors.h"

namespace spume::coupling {

/// Bubbles as a file lists them: columns of equal length in the order of the file.
struct BubbleTable {
  std::vector<std::uint64_t> id;          ///< all different
  std::vector<Eigen::Vector3d> position;  ///< finite [m]
  std::vector<double> radius;             ///< finite, > 0 [m]
  std::vector<Eigen::Vector3d> velocity;  ///< finite [m/s]; zero where the file gives none
  std::vector<double> wetness;            ///< lambda of Eq. 1, 0 to 1 [-]; empty where the file gives none
  std::vector<std::size_t> line;          ///< of the file, from 1; empty if it has none
  bool isNumbered = false;                ///< the file gives no ids: those here count its rows from 0
  std::vector<std::string> unread;        ///< columns of a CSV that mean nothing here, as its header has them

  std::size_t size() const { return id.size(); }
  void resize(std::size_t count);
  /// Where bubble `row` of the file `path` stands, for messages.
  std::string placeOf(const std::string& path, std::size_t row) const;
};

/// Reads .csv, .ply or .vdb (points as runs cache them), told apart by the ending of the name. Throws
/// FileError (missing or unreadable) or SceneError with file:line:column (binary files: the vertex), the
/// value, its range and a remedy: a column missing or given twice, a short or long row, no number, a radius
/// that is not finite and positive, a wetness outside 0 to 1, an id used twice, an unknown ending.
BubbleTable readBubbleTable(const std::string& path);

/// Comma-separated text with a header that names at least id, x, y, z and r, in any order; vx, vy and vz are
/// read if all three are there, and so is wetness; other columns become `unread`. Blank lines, lines that
/// start with '#', blanks around fields, CRLF and a byte order mark are fine. `path` is for messages. Throws
/// SceneError, also if there is no bubble.
BubbleTable parseBubbleCsv(const std::string& path, std::string_view text);

/// PLY, ascii or binary_little_endian, whose first element is `vertex` with x, y, z and one of radius, pscale
/// and r; id, vx, vy, vz and wetness are read if there, and bubbles without id are numbered from 0. Other
/// properties, which renderers need, are passed over. No vertex at all is fine. `path` is for messages.
/// Throws SceneError.
BubbleTable parseBubblePly(const std::string& path, std::string_view bytes);

/// What a user should know of columns that are not read, "b.csv: column 'lambda' is not read; those that are:
/// id, x ..."; empty if all are.
std::string wordsOnUnread(const std::string& path, const BubbleTable& bubbles);

/// Throws SceneError at the first bubble that is out of range, or whose id was used before. `placeOf(row,
/// column)` says where its value of column "id", "x" ... stands.
void checkBubbles(const BubbleTable& bubbles,
                  const std::function<std::string(std::size_t row, std::string_view column)>& placeOf);

}  // namespace spume::coupling
