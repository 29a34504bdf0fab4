#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "apps/preview/bubble_shade.h"
#include "apps/preview/film_surfaces.h"
#include "apps/preview/film_thickness.h"
#include "apps/preview/light_map.h"
#include "apps/preview/optics.h"
#include "apps/preview/thin_film.h"
#include "foam/forces/strong_spring.h"
#include "foam/presets.h"
#include "tests/support/preview_tank.h"

namespace {

using namespace spume;
using apps::BubbleCells;
using apps::Vec3;
using Eigen::Vector3d;

constexpr float kRoundOff = 1e-5f;        // a few dozen float operations on numbers of order 1
constexpr float kRoundOffLength = 1e-7f;  // the same on lengths of 0.1 m, after cancelling squares [m]

Tank emptyTank() {
  return Tank(12, [](const Vector3d&) { return 1.0; });
}

/// A scene with its optics, kept together.
struct Bench {
  apps::PreviewScene scene;
  apps::GlassBox box;
  BubbleCells cells;
  apps::RayScene rays;
  apps::Optics optics;
  explicit Bench(const apps::PreviewScene& view)
      : scene(view),
        box(scene),
        cells(scene),
        rays(scene, cells, apps::meshLevelSet(scene.grid, scene.phi, scene.lower, scene.upper),
             solidMeshes()),
        optics(scene, box, cells, nullptr, rays, false) {}
  std::vector<apps::SurfaceMesh> solidMeshes() const {
    std::vector<apps::SurfaceMesh> meshes;
    for (const apps::PreviewSolid& solid : scene.solids)
      meshes.push_back(apps::meshDistance(solid.distance, scene.lower, scene.upper, 48));
    return meshes;
  }
};

}  // namespace

TEST(ThinFilm, QuarterWaveMatchesClosedForm) {
  const float n = apps::kWaterIndex;
  const float exact = std::pow((1 - n * n) / (1 + n * n), 2.0f);
  constexpr float kBand = 0.01f;  // the band's width takes off 1/8 (pi width/centre)^2, below 1 %
  for (int c = 0; c < 3; ++c) {
    const float thickness = apps::kBandCentre[c] / (4 * n);
    EXPECT_NEAR(apps::filmPhase(1, thickness, apps::kBandCentre[c]), M_PI, kRoundOff);
    EXPECT_NEAR(apps::filmReflectance(1, thickness)[c] / exact, 1, kBand);
  }
}

TEST(ThinFilm, IsBlackWhenThinAndGreyWhenThick) {
  const float once = apps::fresnelReflectance(1, apps::kWaterIndex);
  EXPECT_LT(apps::filmReflectance(1, 5e-9f).maxCoeff(),
            0.04f * once);  // 4 R sin^2(0.09 rad) = 0.033 R in blue
  const Eigen::Vector3f thick = apps::filmReflectance(1, 1e-5f);
  EXPECT_NEAR(thick.maxCoeff() - thick.minCoeff(), 0, kRoundOff);
  EXPECT_NEAR(thick[0], 2 * once / (1 + once * once), kRoundOff);
}

TEST(ThinFilm, PhaseShrinksWithTheCosineInside) {
  const float sine = 0.8f, n = apps::kWaterIndex;
  const float ratio = apps::filmPhase(0.6f, 3e-7f, 5e-7f) / apps::filmPhase(1, 3e-7f, 5e-7f);
  EXPECT_NEAR(ratio, std::sqrt(1 - sine * sine / (n * n)), kRoundOff);
}

TEST(FilmThickness, IsThatOfThePairAndDrains) {
  const coupling::LookSpec look;
  const Vec3 side = Vec3::UnitX();
  const float young = apps::filmThickness(look, 3, 7, 0, side);
  EXPECT_EQ(young, apps::filmThickness(look, 7, 3, 0, side));
  EXPECT_NE(young, apps::filmThickness(look, 3, 8, 0, side));
  const float old = apps::filmThickness(look, 3, 7, static_cast<float>(look.filmDrainage), side);
  const auto thin = static_cast<float>(look.filmThin);
  EXPECT_NEAR((old - thin) / (young - thin), std::exp(-1.0f), kRoundOff);
}

TEST(BubbleCells, CutPairMeetsOnTheRadicalPlane) {
  Tank tank = emptyTank();
  const double r = 0.01, s = 0.007, d = 0.012;
  tank.addBubble({0.05, 0.05, 0.05}, r);
  tank.addBubble({0.05 + d, 0.05, 0.05}, s);
  const BubbleCells cells(tank.scene());
  const double plane = (d * d + r * r - s * s) / (2 * d);
  for (const double off : {0.0, 0.4, 0.9}) {  // shares of the film's radius
    const float y = static_cast<float>(off * std::sqrt(r * r - plane * plane));
    const Vec3 origin(0, 0.05f + y, 0.05f);
    BubbleCells::Stretch first, second;
    ASSERT_TRUE(cells.cut(0, origin, Vec3::UnitX(), first));
    ASSERT_TRUE(cells.cut(1, origin, Vec3::UnitX(), second));
    EXPECT_NEAR(first.out, 0.05 + plane, kRoundOffLength);
    EXPECT_EQ(cells.neighbour(first.faceOut), 1);
    EXPECT_NEAR(second.in, first.out, kRoundOffLength);
    EXPECT_EQ(first.faceIn, BubbleCells::kSkin);
    EXPECT_NEAR(second.out, 0.05 + d + std::sqrt(s * s - y * y), kRoundOffLength);
  }
}

TEST(FilmSurfaces, AreCrossedWhereTheFilmsHaveGone) {
  Tank tank = emptyTank();
  foam::BubbleStore bubbles;
  const double r = 0.01, d = 0.012, bulge = 0.001;
  for (const Vector3d& x : {Vector3d(0.05, 0.05, 0.05), Vector3d(0.05 + d, 0.05, 0.05)}) {
    tank.addBubble(x, r);
    bubbles.add({.position = x, .radius = r});
  }
  foam::SoapFilms films = foam::soapFilms(bubbles);
  ASSERT_EQ(films.network.films.size(), 1u);
  for (foam::FilmNode& node : films.network.nodes)  // a cone towards the second bubble, its rim as it was
    node.position.x() += bulge * (1 - (node.position - Vector3d(0.05 + d / 2, 0.05, 0.05)).norm() /
                                          std::sqrt(r * r - d * d / 4));
  apps::PreviewScene scene = tank.scene();
  scene.look.plateauBorder = 0;
  const Bench bench(scene);
  const apps::FilmSurfaces surfaces(films, bubbles.size(), 1e-7f);
  const apps::Optics optics(bench.scene, bench.box, bench.cells, &surfaces, bench.rays, false);

  apps::LightPath path = optics.startAt(Vec3(0.03f, 0.05f, 0.05f), Vec3::UnitX());
  const double skin = 0.05 - r, film = 0.05 + d / 2 + bulge, far = 0.05 + d + r;
  const std::array<std::pair<double, int>, 3> met{{{skin, 0}, {film, 1}, {far, -1}}};
  for (const auto& [x, behind] : met) {
    const apps::Crossing crossing = optics.next(path);
    EXPECT_NEAR(path.origin.x(), x, kRoundOffLength);
    EXPECT_EQ(crossing.behind.bubble, behind);
    EXPECT_LT(crossing.normal.dot(path.direction), 0);
    path = crossing.behind;
  }
}

TEST(BubbleCells, TileTheUnionOfTheBalls) {
  Tank tank = emptyTank();
  std::mt19937 random(5);
  const auto draw = [&](double low, double high) { return low + (high - low) * random() / 4294967296.0; };
  for (int b = 0; b < 60; ++b)
    tank.addBubble({draw(0.03, 0.07), draw(0.03, 0.07), draw(0.03, 0.07)}, draw(0.004, 0.012));
  const BubbleCells cells(tank.scene());
  constexpr float kSum = 60 * 2e-7f;  // rounding of every stretch [m]
  for (int n = 0; n < 50; ++n) {
    const Vec3 origin(0, static_cast<float>(draw(0.03, 0.07)), static_cast<float>(draw(0.03, 0.07)));
    float tiled = 0;
    std::vector<std::pair<double, double>> chords;
    for (int b = 0; b < cells.size(); ++b) {
      BubbleCells::Stretch stretch;
      if (cells.cut(b, origin, Vec3::UnitX(), stretch)) tiled += stretch.out - stretch.in;
      const Vector3d& x = tank.position[b];
      const double half2 =
          tank.radius[b] * tank.radius[b] - std::pow(origin.y() - x.y(), 2) - std::pow(origin.z() - x.z(), 2);
      if (half2 > 0) chords.emplace_back(x.x() - std::sqrt(half2), x.x() + std::sqrt(half2));
    }
    std::sort(chords.begin(), chords.end());
    double covered = 0, reached = -1;
    for (const auto& [from, to] : chords) {
      covered += std::max(0.0, to - std::max(from, reached));
      reached = std::max(reached, to);
    }
    EXPECT_NEAR(tiled, covered, kSum);
  }
}

TEST(BubbleCells, SkinsJoinWithoutACrease) {
  Tank tank = emptyTank();
  tank.addBubble({0.045, 0.05, 0.05}, 0.008);
  tank.addBubble({0.055, 0.05, 0.05}, 0.008);
  const BubbleCells cells(tank.scene());
  const Vec3 rim(0.05f, 0.05f + std::sqrt(0.008f * 0.008f - 0.005f * 0.005f), 0.05f);
  for (int b = 0; b < 2; ++b) {
    const apps::Rounding rounded = cells.roundedAt(b, BubbleCells::kSkin, rim, 0.001f);
    EXPECT_NEAR(rounded.share, 1, 1e-3f);           // the rim is the middle of the border
    EXPECT_NEAR(rounded.normal.y(), 1, kRoundOff);  // symmetry
  }
}

TEST(BubbleCells, SwallowedBubbleHasNoCell) {
  Tank tank = emptyTank();
  tank.addBubble({0.05, 0.05, 0.05}, 0.01);
  tank.addBubble({0.052, 0.05, 0.05}, 0.003);
  const BubbleCells cells(tank.scene());
  BubbleCells::Stretch stretch;
  EXPECT_FALSE(cells.cut(1, {0, 0.05f, 0.05f}, Vec3::UnitX(), stretch));
  ASSERT_TRUE(cells.cut(0, {0, 0.05f, 0.05f}, Vec3::UnitX(), stretch));
  EXPECT_NEAR(stretch.out - stretch.in, 0.02, kRoundOffLength);
}

TEST(Optics, LiquidAbsorbsAsBeerAndLambertSay) {
  const Tank tank(12, [](const Vector3d& x) { return x.y() - 0.06; });
  apps::PreviewScene scene = tank.scene();
  scene.look.liquidColour = {0.5, 0.25, 0.1};
  scene.look.colourDepth = 0.02;
  scene.look.box = coupling::BoxLook::none;
  const Bench bench(scene);
  apps::LightPath path{{0.05f, 0.2f, 0.05f}, -Vec3::UnitY()};
  path = bench.optics.next(path).behind;
  apps::Crossing crossing = bench.optics.next(path);  // the surface
  EXPECT_NEAR(path.origin.y(), 0.06f, kRoundOffLength);
  EXPECT_TRUE(crossing.behind.inWater);
  EXPECT_NEAR(crossing.mirrored[0], apps::fresnelReflectance(1, apps::kWaterIndex), kRoundOff);
  path = crossing.behind;
  crossing = bench.optics.next(path);
  EXPECT_EQ(crossing.kind, apps::Boundary::table);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(crossing.passed[c], std::pow(scene.look.liquidColour[c], 0.06 / 0.02), kRoundOff);
}

TEST(Optics, PaneShiftsLightAndKeepsItsDirection) {
  const Tank tank = emptyTank();
  const Bench bench(tank.scene());
  const Vec3 direction = Vec3(0.8f, -0.1f, 0.3f).normalized();
  apps::LightPath path{{-0.05f, 0.07f, 0.03f}, direction};
  apps::Crossing crossing = bench.optics.next(path);
  path = crossing.behind;
  EXPECT_EQ(path.place, apps::Place::glass);
  EXPECT_NEAR(path.direction.z() * apps::kGlassIndex, direction.z(), kRoundOff);
  path = bench.optics.next(path).behind;
  EXPECT_EQ(path.place, apps::Place::inside);
  EXPECT_NEAR((path.direction - direction).norm(), 0, kRoundOff);
}

TEST(Optics, PathThroughAPairCrossesSkinFilmSkin) {
  Tank tank = emptyTank();
  tank.addBubble({0.045, 0.05, 0.05}, 0.008);
  tank.addBubble({0.055, 0.05, 0.05}, 0.008);
  const Bench bench(tank.scene());
  apps::LightPath path = bench.optics.startAt({0.01f, 0.05f, 0.05f}, Vec3::UnitX());
  const float places[] = {0.037f, 0.05f, 0.063f};
  const int bubbles[] = {0, 1, -1};
  for (int n = 0; n < 3; ++n) {
    const apps::Crossing crossing = bench.optics.next(path);
    EXPECT_NEAR(path.origin.x(), places[n], kRoundOffLength);
    EXPECT_EQ(crossing.behind.bubble, bubbles[n]);
    EXPECT_NEAR((crossing.behind.direction - Vec3::UnitX()).norm(), 0, kRoundOff);
    path = crossing.behind;
  }
}

TEST(Optics, SolidGlassBendsLightAndMatteStopsIt) {
  Tank tank = emptyTank();
  for (const apps::Material material : {apps::Material::glass, apps::Material::matte}) {
    apps::PreviewScene scene = tank.scene();
    const auto ball = [](const Vector3d& x) { return (x - Vector3d(0.05, 0.05, 0.05)).norm() - 0.02; };
    scene.solids.push_back({ball, material});
    const Bench bench(scene);
    apps::LightPath path = bench.optics.startAt({0.01f, 0.06f, 0.05f}, Vec3::UnitX());
    const apps::Crossing crossing = bench.optics.next(path);
    constexpr float kMesh = 1e-4f;  // triangles of 2 mm against a ball of 20 mm: edge^2/(8 r) [m]
    EXPECT_NEAR((path.origin - Vec3::Constant(0.05f)).norm(), 0.02f, kMesh);
    EXPECT_EQ(crossing.kind,
              material == apps::Material::matte ? apps::Boundary::matte : apps::Boundary::clear);
    if (material == apps::Material::glass) {
      EXPECT_LT(crossing.behind.direction.y(), 0);  // towards the axis
    }
  }
}

TEST(LightMap, EmptyTableIsEvenAndASolidCastsShadow) {
  Tank tank = emptyTank();
  apps::PreviewScene scene = tank.scene();
  scene.look.box = coupling::BoxLook::none;
  const auto lightAt = [&](const Vec3& p) {
    const Bench bench(scene);
    return apps::LightMap(bench.optics, bench.box, Vec3::UnitY(), 1).at(p)[0];
  };
  EXPECT_NEAR(lightAt({0.05f, 0, 0.05f}), 1, 1e-4f);  // lattice rays share their light among texels exactly
  scene.solids.push_back({[](const Vector3d& x) { return (x - Vector3d(0.05, 0.02, 0.05)).norm() - 0.02; },
                          apps::Material::matte});
  EXPECT_NEAR(lightAt({0.05f, 0, 0.05f}), 0, 1e-4f);
  EXPECT_NEAR(lightAt({0.01f, 0, 0.01f}), 1, 1e-4f);
}

TEST(BubbleShade, CountsContactsAndWeighsPushes) {
  foam::BubbleStore bubbles;
  const double r = 0.002, d = 0.003;
  for (int b = 0; b < 3; ++b) {
    foam::NewBubble bubble;
    bubble.position = {b * d + (b == 2 ? 1 : 0), 0, 0};
    bubble.radius = r;
    bubble.wetness = 0.6;
    bubbles.add(bubble);
  }
  const foam::FoamParams params = foam::makePreset(foam::Preset::physical);
  const auto contacts = apps::bubbleShade(apps::PreviewStyle::contacts, params, bubbles);
  EXPECT_NEAR(contacts[0], 1.0 / 14, 1e-12);
  EXPECT_EQ(contacts[2], 0);
  const double push = foam::springStiffness(params, r, r) *
                      (foam::restLength(r, r, bubbles.wetness[0]) - d);  // compressed: a linear spring
  const auto pressure = apps::bubbleShade(apps::PreviewStyle::pressure, params, bubbles);
  EXPECT_NEAR(pressure[0], std::clamp(push / (4 * M_PI * r * r) / (2 * params.surfaceTension / r), 0.0, 1.0),
              1e-12);
  EXPECT_TRUE(apps::bubbleShade(apps::PreviewStyle::beauty, params, bubbles).empty());
}
