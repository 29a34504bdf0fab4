#include "apps/preview/legend.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "apps/preview/bubble_paint.h"
#include "apps/preview/tone.h"

namespace spume::apps {
namespace {

constexpr int kGlyphWidth = 5, kGlyphHeight = 7, kAdvance = 6;  // of a letter [dots]

/// Letters as seven rows of five dots, for the words of the legends.
const std::array<std::uint8_t, kGlyphHeight>& glyph(char letter) {
  static const std::map<char, std::array<std::uint8_t, kGlyphHeight>> kGlyphs{
      {'A', {0x0E, 0x11, 0x11, 0x1F, 0x11, 0x11, 0x11}},
      {'C', {0x0E, 0x11, 0x10, 0x10, 0x10, 0x11, 0x0E}},
      {'D', {0x1E, 0x11, 0x11, 0x11, 0x11, 0x11, 0x1E}},
      {'E', {0x1F, 0x10, 0x10, 0x1E, 0x10, 0x10, 0x1F}},
      {'F', {0x1F, 0x10, 0x10, 0x1E, 0x10, 0x10, 0x10}},
      {'I', {0x0E, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0E}},
      {'L', {0x10, 0x10, 0x10, 0x10, 0x10, 0x10, 0x1F}},
      {'N', {0x11, 0x19, 0x15, 0x13, 0x11, 0x11, 0x11}},
      {'O', {0x0E, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0E}},
      {'P', {0x1E, 0x11, 0x11, 0x1E, 0x10, 0x10, 0x10}},
      {'Q', {0x0E, 0x11, 0x11, 0x11, 0x15, 0x12, 0x0D}},
      {'R', {0x1E, 0x11, 0x11, 0x1E, 0x14, 0x12, 0x11}},
      {'S', {0x0F, 0x10, 0x10, 0x0E, 0x01, 0x01, 0x1E}},
      {'T', {0x1F, 0x04, 0x04, 0x04, 0x04, 0x04, 0x04}},
      {'U', {0x11, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0E}},
      {'0', {0x0E, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0E}},
      {'1', {0x04, 0x0C, 0x04, 0x04, 0x04, 0x04, 0x0E}},
      {'4', {0x02, 0x06, 0x0A, 0x12, 0x1F, 0x02, 0x02}},
      {' ', {0, 0, 0, 0, 0, 0, 0}}};
  return kGlyphs.at(letter);
}

/// Draws in dots of whole pixels from the lower left corner of the picture.
class Pen {
 public:
  explicit Pen(Image& image) : image_(image), dot_(std::max(1, image.height / 360)) {}

  /// Paints the dots [x, x + width) x [y, y + height) with y upwards, in display colour.
  void box(int x, int y, int width, int height, const Vec3& colour) {
    for (int row = y * dot_; row < (y + height) * dot_; ++row)
      for (int column = x * dot_; column < (x + width) * dot_; ++column) pixel(column, row, colour);
  }
  void text(int x, int y, const std::string& words) {
    for (std::size_t n = 0; n < words.size(); ++n)
      for (int row = 0; row < kGlyphHeight; ++row)
        for (int column = 0; column < kGlyphWidth; ++column)
          if (glyph(words[n])[row] >> (kGlyphWidth - 1 - column) & 1)
            box(x + kAdvance * static_cast<int>(n) + column, y + kGlyphHeight - 1 - row, 1, 1, kInk);
  }

 private:
  void pixel(int x, int y, const Vec3& colour) {
    const int row = image_.height - 1 - y;
    if (x < 0 || row < 0 || x >= image_.width || row >= image_.height) return;
    for (int c = 0; c < 3; ++c)
      image_.rgb[3 * (std::size_t(row) * image_.width + x) + c] =
          static_cast<std::uint8_t>(255 * std::clamp(colour[c], 0.0f, 1.0f) + 0.5f);
  }

  inline static const Vec3 kInk{0.08f, 0.09f, 0.10f};
  Image& image_;
  int dot_;
};

constexpr int kMargin = 10, kLine = 12, kSwatch = 8;  // [dots]

void drawClasses(Pen& pen) {
  const char* const kNames[] = {"LIQUID", "SURFACE", "AIR"};
  for (int n = 0; n < 3; ++n) {
    const int y = kMargin + kLine * (2 - n);
    pen.box(kMargin, y, kSwatch, kSwatch, toDisplay(classColour(static_cast<foam::BubbleClass>(n))));
    pen.text(kMargin + kLine, y, kNames[n]);
  }
}

void drawScale(Pen& pen, const std::string& name, const std::string& most) {
  constexpr int kLength = 80;
  for (int n = 0; n < kLength; ++n)
    pen.box(kMargin + n, kMargin + kLine, 1, kSwatch,
            toDisplay(shadeColour(static_cast<float>(n) / (kLength - 1))));
  pen.text(kMargin, kMargin, "0");
  pen.text(kMargin + kLength - kAdvance * static_cast<int>(most.size()) + 1, kMargin, most);
  pen.text(kMargin, kMargin + 2 * kLine, name);
}

}  // namespace

void drawLegend(PreviewStyle style, Image& image) {
  Pen pen(image);
  if (style == PreviewStyle::classes) drawClasses(pen);
  if (style == PreviewStyle::contacts) drawScale(pen, "CONTACTS", "14");
  if (style == PreviewStyle::pressure) drawScale(pen, "PRESSURE", "1");
}

}  // namespace spume::apps
