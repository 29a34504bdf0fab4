#include <gtest/gtest.h>
#include <png.h>
#include <tbb/global_control.h>

#include <cmath>
#include <filesystem>

#include "apps/preview/fresnel.h"
#include "apps/preview/renderer.h"
#include "apps/preview/surface_mesh.h"
#include "coupling/errors.h"
#include "tests/support/preview_tank.h"
#include "tests/support/temporary_path.h"

namespace {

using namespace spume;
using apps::Vec3;

constexpr float kRoundOff = 1e-5f;  // a few dozen float operations on numbers of order 1

double volumeInside(const apps::SurfaceMesh& mesh) {
  double volume = 0;
  for (std::size_t t = 0; t < mesh.triangles(); ++t)
    volume += mesh.position[3 * t].cast<double>().dot(
                  mesh.position[3 * t + 1].cast<double>().cross(mesh.position[3 * t + 2].cast<double>())) /
              6;
  return volume;
}

apps::SurfaceMesh sphereMesh(int n) {
  const Eigen::Vector3d centre(0.05, 0.051, 0.049);
  const Tank tank(n, [&](const Eigen::Vector3d& x) { return (x - centre).norm() - 0.03; });
  return apps::meshLevelSet(tank.grid, tank.phi, tank.grid.origin, tank.grid.upper());
}

}  // namespace

TEST(Fresnel, NormalIncidenceMatchesClosedForm) {
  const float n = apps::kWaterIndex;
  EXPECT_NEAR(apps::fresnelReflectance(1, n), (n - 1) * (n - 1) / ((n + 1) * (n + 1)), kRoundOff);
  EXPECT_NEAR(apps::fresnelReflectance(1, 1 / n), apps::fresnelReflectance(1, n), kRoundOff);
}

TEST(Fresnel, BrewsterAngleHalvesTheReflectance) {
  const float n = apps::kWaterIndex;
  const float cosIn = 1 / std::sqrt(1 + n * n);  // tan = n: the parallel part vanishes
  const float s = (1 - n * n) / (1 + n * n);
  EXPECT_NEAR(apps::fresnelReflectance(cosIn, n), 0.5f * s * s, kRoundOff);
}

TEST(Fresnel, BeyondTheCriticalAngleAllIsReflected) {
  const float sinCritical = 1 / apps::kWaterIndex;
  const auto at = [&](float sine) {
    return apps::fresnelReflectance(std::sqrt(1 - sine * sine), 1 / apps::kWaterIndex);
  };
  EXPECT_EQ(at(sinCritical * 1.001f), 1);
  EXPECT_LT(at(sinCritical * 0.99f), 0.7f);
}

TEST(Fresnel, RefractionObeysSnell) {
  const Vec3 normal = Vec3::UnitY(), in = Vec3(0.6f, -0.8f, 0);
  const Vec3 out = apps::refract(in, normal, apps::kWaterIndex);
  EXPECT_NEAR(out.x() * apps::kWaterIndex, in.x(), kRoundOff);
  EXPECT_NEAR(out.norm(), 1, kRoundOff);
  EXPECT_LT(out.y(), 0);
}

TEST(SurfaceMesh, SphereVolumeConvergesAtSecondOrder) {
  const double exact = 4.0 / 3 * M_PI * 0.03 * 0.03 * 0.03;
  const double coarse = std::abs(volumeInside(sphereMesh(16)) / exact - 1);
  const double fine = std::abs(volumeInside(sphereMesh(32)) / exact - 1);
  constexpr double kOrderTwo = 3.0;  // halving dx must cut the error about fourfold
  EXPECT_GT(coarse / fine, kOrderTwo);
}

TEST(SurfaceMesh, NormalsPointOutOfTheLiquid) {
  const apps::SurfaceMesh mesh = sphereMesh(24);
  const Vec3 centre(0.05f, 0.051f, 0.049f);
  constexpr float kNearlyParallel = 0.99f;  // gradients of a distance 7 cells from its centre, second order
  ASSERT_FALSE(mesh.position.empty());
  for (std::size_t v = 0; v < mesh.position.size(); ++v)
    EXPECT_GT(mesh.normal[v].dot((mesh.position[v] - centre).normalized()), kNearlyParallel);
}

TEST(SurfaceMesh, FlatPoolReachesTheWallsExactly) {
  const Tank tank(10, [](const Eigen::Vector3d& x) { return x.y() - 0.0437; });
  const apps::SurfaceMesh mesh = apps::meshLevelSet(tank.grid, tank.phi, tank.grid.origin, tank.grid.upper());
  Vec3 least = Vec3::Constant(1), most = -least;
  double area = 0;
  for (std::size_t v = 0; v < mesh.position.size(); ++v) {
    least = least.cwiseMin(mesh.position[v]);
    most = most.cwiseMax(mesh.position[v]);
    EXPECT_NEAR(mesh.position[v].y(), 0.0437f, 1e-7f);
  }
  for (std::size_t t = 0; t < mesh.triangles(); ++t)
    area += 0.5 * (mesh.position[3 * t + 1] - mesh.position[3 * t])
                      .cross(mesh.position[3 * t + 2] - mesh.position[3 * t])
                      .norm();
  EXPECT_EQ(least.x(), 0);
  EXPECT_EQ(most.z(), 0.1f);
  EXPECT_NEAR(area, 0.01, 1e-7);  // each point of the square covered once, to the rounding of float corners
}

TEST(Preview, SameBytesForAnyNumberOfThreads) {
  Tank tank(12, [](const Eigen::Vector3d& x) { return x.y() - 0.05 - 0.004 * std::sin(90 * x.x()); });
  tank.addBubble({0.05, 0.03, 0.06}, 0.006);
  tank.addBubble({0.055, 0.05, 0.06}, 0.006);
  const apps::PreviewSettings settings{.width = 64, .height = 48};
  const auto withThreads = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return apps::renderPreview(tank.scene(), settings).rgb;
  };
  EXPECT_EQ(withThreads(1), withThreads(4));
}

TEST(Preview, ShowsWaterAndBubbles) {
  Tank empty(12, [](const Eigen::Vector3d&) { return 1.0; });
  Tank filled(12, [](const Eigen::Vector3d& x) { return x.y() - 0.05; });
  Tank bubbly = filled;
  bubbly.addBubble({0.05, 0.03, 0.06}, 0.01);
  const apps::PreviewSettings settings{.width = 64, .height = 48};
  const auto emptyPicture = apps::renderPreview(empty.scene(), settings).rgb;
  const auto filledPicture = apps::renderPreview(filled.scene(), settings).rgb;
  EXPECT_NE(emptyPicture, filledPicture);
  EXPECT_NE(filledPicture, apps::renderPreview(bubbly.scene(), settings).rgb);
}

TEST(Preview, PngReadsBackAsWritten) {
  apps::Image image(3, 2);
  for (std::size_t b = 0; b < image.rgb.size(); ++b) image.rgb[b] = static_cast<std::uint8_t>(13 * b + 5);
  const std::string path = temporaryPath("spume_preview_test.png");
  apps::writePng(image, path);
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&header, path.c_str()));
  header.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> read(PNG_IMAGE_SIZE(header));
  ASSERT_TRUE(png_image_finish_read(&header, nullptr, read.data(), 0, nullptr));
  EXPECT_EQ(read, image.rgb);
  EXPECT_FALSE(std::filesystem::exists(path + ".tmp"));
  std::filesystem::remove(path);
}

TEST(Preview, UnwritablePictureNamesThePath) {
  try {
    apps::writePng(apps::Image(2, 2), "/nonexistent/folder/x.png");
    FAIL() << "no exception";
  } catch (const coupling::FileError& error) {
    EXPECT_NE(std::string(error.what()).find("/nonexistent/folder/x.png"), std::string::npos);
  }
}
