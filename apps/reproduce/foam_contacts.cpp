#include <algorithm>
#include <string>

#include "apps/reproduce/foam_studies.h"
#include "apps/reproduce/jamming_path.h"
#include "apps/reproduce/power_law.h"
#include "apps/reproduce/soft_packing.h"

namespace spume::apps {
namespace {

constexpr int kPackings = 3, kDiscs = 1000;
constexpr double kTop = 0.94;      ///< gas share at the start, about 0.1 beyond jamming
constexpr double kNearest = 2e-4;  ///< beyond jamming; there 1000 discs have 20 contacts too many
constexpr double kBetween = 0.75;  ///< exponents below it are nearer to a square root than to a line

/// Contacts of packings of one kind against the gas share.
struct ContactLaw {
  double density = 0;  ///< at which they jam, mean
  double unrest = 0, worstArea = 0;
  bool settled = true;
  PowerLaw excess;  ///< of the contacts beyond the isostatic number, over the share beyond jamming

  void add(const JammingPath& path) {
    density += path.jams / kPackings;
    unrest = std::max(unrest, path.unrest), worstArea = std::max(worstArea, path.worstArea);
    settled = settled && path.settled;
    for (const auto& [fraction, census] : path.states)
      excess.add(fraction - path.jams, excessContacts(census, kDiscs, 2));
  }
  std::string name() const {
    return excess.exponent() < kBetween ? "a square root, not a line" : "a line, not a square root";
  }
};

ResultRow contactRow(const char* kind, const char* quantity, const char* reference, const char* source) {
  return {.resolution = std::string("3 of 1000 ") + kind,
          .quantity = quantity,
          .reference = reference,
          .source = source};
}

/// The figures that both kinds have, `exponent` the published one.
std::vector<ResultRow> rowsOf(const char* kind, const ContactLaw& law, const char* exponent) {
  const char* kSource = "Winkelmann et al. 2017";
  ResultRow density = contactRow(kind, "area fraction at which they jam", "0.842", "O'Hern et al. 2003"),
            growth = contactRow(kind, "exponent of Z - Zc beyond it, up to 0.94", exponent, kSource),
            rest = contactRow(kind, "largest net force left, of the mean push", "0", "exact");
  growth.note = law.name();
  density.note = "by a descent of their own: the foam's step holds volumes of balls, no areas of discs";
  if (!law.settled) rest.note = "not every packing came to rest";
  return {reportOnly(density, law.density, "-"), reportOnly(growth, law.excess.exponent(), "-"),
          aimAtMost(rest, law.unrest, SoftPacking::kAtRest, "-")};
}

/// G13: whether contacts grow as in soft discs or as in foams once cells hold their areas. Both kinds start
/// from the same discs at rest. An overlap takes from a disc an area of its power 3/2, by which the radius
/// then grows: the nearer to jamming, the less it differs from a soft disc. lambda = 1 in both: drier bubbles
/// pull each other, and where these jam they come to rest without any force.
std::vector<ResultRow> contactGrowth(const StudyContext&) {
  ContactLaw discs, cells;
  double swollen = 0;
  for (std::uint64_t seed = 1; seed <= kPackings; ++seed) {
    SoftPacking packing({.count = kDiscs, .dimensions = 2, .ratio = 1.4, .fraction = kTop, .seed = seed});
    discs.settled = packing.relax() && discs.settled;
    SoftPacking foam = packing;
    foam.holdAreas();
    cells.settled = foam.relax() && cells.settled;
    for (std::size_t i = 0; i < kDiscs; i += 2) swollen += 2 * (foam.radius(i) - 1) / kDiscs / kPackings;
    discs.add(JammingPath(packing, kNearest));
    cells.add(JammingPath(foam, kNearest));
  }
  const char* kCells = "power cells that hold their areas";
  std::vector<ResultRow> rows = rowsOf("soft discs, half of them 1.4 larger", discs, "0.5, a square root");
  for (const ResultRow& row : rowsOf(kCells, cells, "1, a line, in foams")) rows.push_back(row);
  ResultRow area = contactRow(kCells, "area of a cell off what it holds, worst of all", "0", "exact"),
            swell = contactRow(kCells, "growth of the smaller discs' radii at a gas share of 0.94", "", "");
  rows.push_back(aimAtMost(area, cells.worstArea, SoftPacking::kAreaOff, "-"));
  rows.push_back(reportOnly(swell, 100 * swollen, "%"));
  return rows;
}

}  // namespace

std::vector<Study> contactStudies() {
  return {{"G13", "contacts of discs and of cells", 100, contactGrowth}};
}

}  // namespace spume::apps
