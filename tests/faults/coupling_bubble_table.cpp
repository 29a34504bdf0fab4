#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "coupling/bubble_table.h"

namespace spume::coupling {
namespace {

/// A file's contents that must be refused, and parts of the message: place, value, range, remedy.
struct BadFile {
  std::string name, contents;
  std::vector<std::string> expected;

  friend void PrintTo(const BadFile& bad, std::ostream* out) { *out << bad.name; }
};

std::string messageOf(const BadFile& bad) {
  try {
    if (bad.contents.starts_with("ply"))
      parseBubblePly("b.ply", bad.contents);
    else
      parseBubbleCsv("b.csv", bad.contents);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

class BadBubbles : public testing::TestWithParam<BadFile> {};

TEST_P(BadBubbles, AreRefusedWithPlaceAndRemedy) {
  const std::string message = messageOf(GetParam());
  ASSERT_FALSE(message.empty()) << "the file was accepted";
  for (const std::string& part : GetParam().expected)
    EXPECT_NE(message.find(part), std::string::npos) << part << " is not in: " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << "more than one line: " << message;
}

const std::string kHeader = "id,x,y,z,r\n";
const std::string kRow = "1,0,0,0,1\n";

const BadFile kBadCsv[] = {
    {"Empty", "", {"b.csv: is empty", "id,x,y,z,r"}},
    {"OnlyBlankLines", "\r\n \n\n", {"b.csv: is empty"}},
    {"OnlyComments", "# nothing\n", {"b.csv: is empty"}},
    {"NoBubbles", kHeader, {"b.csv: ", "no bubbles"}},
    {"NegativeRadius", kHeader + kRow + "2,0,0,0,-1\n", {"b.csv:3:9: ", "r = -1", "bubble 2", "> 0 [m]"}},
    {"ZeroRadius", kHeader + "2,0,0,0,0\n", {"b.csv:2:9: ", "r = 0"}},
    {"NotANumberRadius", kHeader + "2,0,0,0,nan\n", {"b.csv:2:9: ", "nan", "finite"}},
    {"InfiniteRadius", kHeader + "2,0,0,0,inf\n", {"b.csv:2:9: ", "inf", "finite"}},
    {"TinyRadius", kHeader + "2,0,0,0,1e-60\n", {"b.csv:2:9: ", "r = 1e-60", "1e-50 to 1e50 m"}},
    {"HugeRadius", kHeader + "2,0,0,0,1e60\n", {"b.csv:2:9: ", "r = 1e+60", "1e-50 to 1e50 m"}},
    {"LostInTheDistance", kHeader + "2,0,-1e15,0,0.1\n", {"b.csv:2:13: ", "precision", "1e+15 m"}},
    {"NotANumberPosition", kHeader + "2,0,NaN,0,1\n", {"b.csv:2:5: ", "y = nan", "finite [m]"}},
    {"DuplicateId", kHeader + kRow + "2,0,0,0,1\n\n1,5,0,0,1\n", {"b.csv:5:1: ", "id 1", "b.csv:2:1;"}},
    {"DuplicateIdUnsorted",
     "x,id,y,z,r\n0,9,0,0,1\n0,3,0,0,1\n0,1,0,0,1\n0,3,0,0,1\n0,9,0,0,1\n",
     {"b.csv:5:3: ", "id 3", "b.csv:3:3;"}},
    {"ShortRow", kHeader + kRow + "2,0,0,0\n", {"b.csv:3:1: ", "4 fields", "5 (id,x,y,z,r)"}},
    {"ShortRowAfterCarriageReturns", "id,x,y,z,r\r\n1,0,0,0,1\r\n2,0\r\n", {"b.csv:3:1: ", "2 fields"}},
    {"LongRow", kHeader + "2,0,0,0,1,7\n", {"b.csv:2:11: ", "more fields than the header's 5"}},
    {"Word", kHeader + "2,0,0,zero,1\n", {"b.csv:2:7: ", "z = 'zero'", "not a number"}},
    {"EmptyField", kHeader + "2,0,,0,1\n", {"b.csv:2:5: ", "y = ''", "not a number"}},
    {"TrailingLetters", kHeader + "2,0,0,0,1mm\n", {"b.csv:2:9: ", "r = '1mm'"}},
    {"Overflow", kHeader + "2,0,0,0,1e999\n", {"b.csv:2:9: ", "r = '1e999'", "double precision"}},
    {"FractionalId", kHeader + "2.5,0,0,0,1\n", {"b.csv:2:1: ", "id = '2.5'", "integer"}},
    {"NegativeId", kHeader + "-2,0,0,0,1\n", {"b.csv:2:1: ", "id = '-2'", "from 0"}},
    {"HugeId", kHeader + "18446744073709551616,0,0,0,1\n", {"b.csv:2:1: ", "2^64 - 1"}},
    {"MissingColumn", "id,x,y,z\n1,0,0,0\n", {"b.csv:1:1: ", "column r is missing", "id,x,y,z"}},
    {"MisnamedColumn", "# foam\nid,x,y,z,radius,age\n", {"b.csv:2:1: ", "column r is missing", "'radius'"}},
    {"CapitalColumn", "id,X,y,z,r\n", {"column x is missing", "'X'"}},
    {"NoHeader", kRow, {"b.csv:1:1: ", "column id is missing", "expected id,x,y,z,r"}},
    {"ColumnTwice", "id,x,y,z,r,x\n", {"b.csv:1:12: ", "column x", "twice"}},
    {"HalfAVelocity", "id,x,y,z,r,vx,vy\n", {"b.csv:1:1: ", "column vz is missing"}},
    {"InfiniteVelocity", "id,x,y,z,r,vx,vy,vz\n1,0,0,0,1,0,0,inf\n", {"b.csv:2:15: ", "vz = inf", "[m/s]"}},
    {"WetnessAboveOne",
     "id,x,y,z,r,wetness\n8,0,0,0,1,1\n9,0,0,0,1,1.01\n",
     {"b.csv:3:11: ", "wetness = 1.01 of bubble 9", "0 (dry) to 1 (wet)"}},
    {"WetnessBelowZero", "wetness,id,x,y,z,r\n-0.5,8,0,0,0,1\n", {"b.csv:2:1: ", "wetness = -0.5"}},
    {"NotANumberWetness", "wetness,id,x,y,z,r\nnan,8,0,0,0,1\n", {"b.csv:2:1: ", "wetness = nan"}},
};
INSTANTIATE_TEST_SUITE_P(Csv, BadBubbles, testing::ValuesIn(kBadCsv),
                         [](const auto& given) { return given.param.name; });

const std::string kAscii = "ply\nformat ascii 1.0\nelement vertex 2\n";
const std::string kBinary = "ply\nformat binary_little_endian 1.0\nelement vertex 2\n";
const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kEnd = "property float radius\nend_header\n";

const BadFile kBadPly[] = {
    {"NoPly", "plyx\n", {"b.ply:1:1: ", "is no PLY file"}},
    {"NoEnd", kAscii + kXyz, {"b.ply: ", "no end_header"}},
    {"NoFormat", "ply\nelement vertex 1\n" + kXyz + kEnd, {"no format"}},
    {"NoElement", "ply\nformat ascii 1.0\nend_header\n", {"no element vertex"}},
    {"BigEndian", "ply\nformat binary_big_endian 1.0\n", {"b.ply:2:8: ", "binary_little_endian"}},
    {"OtherElementFirst", "ply\nformat ascii 1.0\nelement face 1\n", {"b.ply:3:9: ", "expected vertex"}},
    {"BadCount", "ply\nformat ascii 1.0\nelement vertex many\n", {"b.ply:3:16: ", "'many'"}},
    {"List", kAscii + "property list uchar int v\n", {"b.ply:4:1: ", "scalar"}},
    {"UnknownLine", kAscii + "propety float x\n", {"b.ply:4:1: ", "'propety float x'"}},
    {"NoRadius", kAscii + kXyz + "property float scale\nend_header\n", {"no property radius", "'scale'"}},
    {"NoX", kAscii + "property float y\nproperty float z\n" + kEnd, {"no property x"}},
    {"AsciiCutOff", kAscii + kXyz + kEnd + "0 0 0 1\n", {"cut off", "2 vertices"}},
    {"AsciiShortRow", kAscii + kXyz + kEnd + "0 0 0 1\n0 0 0\n", {"b.ply:10:1: ", "3 numbers, expected 4"}},
    {"AsciiLongRow", kAscii + kXyz + kEnd + "0 0 0 1\n0 0 0 1 2\n", {"b.ply:10:9: ", "more numbers"}},
    {"AsciiWord", kAscii + kXyz + kEnd + "0 0 0 1\n0 0 o 1\n", {"b.ply:10:5: ", "z = 'o'"}},
    {"AsciiRadius", kAscii + kXyz + kEnd + "0 0 0 1\n0 0 0 -1\n", {"b.ply:10:7: ", "r = -1", "bubble 1"}},
    {"AsciiDuplicateId",
     kAscii + kXyz + "property int id\n" + kEnd + "0 0 0 5 1\n0 0 0 5 1\n",
     {"b.ply:11:7: id 5", "b.ply:10:7;"}},
    {"AsciiWetness",
     kAscii + kXyz + "property float wetness\n" + kEnd + "0 0 0 1 1\n0 0 0 2 1\n",
     {"b.ply:11:7: wetness = 2 of bubble 1", "0 (dry) to 1 (wet)"}},
    {"BinaryCutOff", kBinary + kXyz + kEnd + std::string(31, '\0'), {"cut off", "2 vertices", "1"}},
    {"BinaryRadius", kBinary + kXyz + kEnd + std::string(32, '\0'), {"b.ply: vertex 0: ", "r = 0"}},
    {"AbsurdCount",
     "ply\nformat binary_little_endian 1.0\nelement vertex 18446744073709551615\n" + kXyz + kEnd,
     {"cut off"}},
};
INSTANTIATE_TEST_SUITE_P(Ply, BadBubbles, testing::ValuesIn(kBadPly),
                         [](const auto& given) { return given.param.name; });

TEST(BubbleTable, OtherEndingsAreRefused) {
  EXPECT_THROW(readBubbleTable("bubbles.txt"), SceneError);
  EXPECT_THROW(readBubbleTable("/nonexistent/bubbles.csv"), FileError);
}

}  // namespace
}  // namespace spume::coupling
