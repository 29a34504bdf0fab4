#include "coupling/cache_listing.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>

#include "fluid/level_set.h"
#include "fluid/parallel.h"

namespace spume::coupling {
namespace {

namespace fs = std::filesystem;

/// Number in `name` = prefix + digits + suffix, or -1.
int numberIn(const std::string& name, const std::string& prefix, const std::string& suffix) {
  if (!name.starts_with(prefix) || !name.ends_with(suffix) || name.size() <= prefix.size() + suffix.size())
    return -1;
  int number = -1;
  const char* end = name.data() + name.size() - suffix.size();
  const auto [stopped, error] = std::from_chars(name.data() + prefix.size(), end, number);
  return error == std::errc{} && stopped == end ? number : -1;
}

/// `phi` with every ghost a copy of the nearest cell.
fluid::DenseField<float> withGhosts(const fluid::DenseField<float>& phi) {
  fluid::DenseField<float> padded(phi.size());
  const Eigen::Vector3i ghost = Eigen::Vector3i::Constant(fluid::kGhost),
                        last = phi.size() - Eigen::Vector3i::Ones();
  fluid::forEachCell(phi.size() + 2 * ghost, [&](int i, int j, int k) {
    const Eigen::Vector3i c = Eigen::Vector3i(i, j, k) - ghost;
    padded(c) = phi(Eigen::Vector3i(c.cwiseMax(0).cwiseMin(last)));
  });
  return padded;
}

}  // namespace

CacheListing listCache(const std::string& folder, const std::string& stem, const std::string& extension) {
  std::map<int, fs::directory_entry> entries;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const int number = numberIn(entry.path().filename().string(), stem + ".", "." + extension);
    if (number >= 0) entries.emplace(number, entry);
  }
  CacheListing listing;
  for (const auto& [number, entry] : entries) {
    listing.frames.push_back(number);
    listing.paths.push_back(entry.path().string());
    listing.bytes += entry.file_size(error);
  }
  return listing;
}

std::string describeFrames(const CacheListing& listing) {
  if (listing.frames.empty()) return "none";
  const int first = listing.frames.front(), last = listing.frames.back();
  const std::string range = std::to_string(first) + "-" + std::to_string(last);
  const std::size_t count = listing.frames.size();
  return count == std::size_t(last - first) + 1 ? range : range + " (" + std::to_string(count) + " files)";
}

std::string describeNumbers(const std::vector<int>& numbers) {
  std::string text;
  for (std::size_t begin = 0, end; begin < numbers.size(); begin = end) {
    end = begin + 1;
    while (end < numbers.size() && numbers[end] == numbers[end - 1] + 1) ++end;
    text.append(text.empty() ? "" : ", ").append(std::to_string(numbers[begin]));
    if (end - begin > 1) text.append("-").append(std::to_string(numbers[end - 1]));
  }
  return text;
}

double cachedLiquidVolume(const LiquidFrame& frame) {
  const fluid::GridSpec& grid = frame.liquid.grid;
  const fluid::DenseField<float> phi = withGhosts(frame.liquid.phi);
  const float dx = static_cast<float>(grid.dx);
  const double cells = fluid::reduceSlabs(
      grid.cells.x(), 0.0,
      [&](int i) {
        double sum = 0;
        for (int j = 0; j < grid.cells.y(); ++j)
          for (int k = 0; k < grid.cells.z(); ++k)
            sum += fluid::liquidFractionOfCell(phi, dx, i, j, k) *
                   std::clamp(0.5f + frame.psi(i, j, k) / dx, 0.0f, 1.0f);
        return sum;
      },
      [](double a, double b) { return a + b; });
  return cells * grid.cellVolume();
}

}  // namespace spume::coupling
