// A step that fails, for whatever reason and wherever it had come to, leaves the state it began with.
#include <gtest/gtest.h>

#include <new>

#include "coupling/checkpoint.h"
#include "coupling/simulation.h"
#include "coupling/state_archive.h"
#include "coupling/still_liquid.h"
#include "foam/errors.h"
#include "tests/support/coupling_shapes.h"

namespace spume::coupling {
namespace {

/// What goes wrong, and at which question that a step asks of the liquid's sampler.
struct Fault {
  int countdown = 0;  ///< 1: the next question fails; 0: none does
  std::function<void()> fail;
};

/// A pool at rest that fails where it is told to.
class FaultyLiquid : public StillLiquid {
 public:
  FaultyLiquid(const Scene& scene, Fault& fault) : StillLiquid(scene), fault_(fault) {}
  std::unique_ptr<foam::LiquidSampler> sampler() const override {
    if (fault_.countdown > 0 && --fault_.countdown == 0) fault_.fail();
    return StillLiquid::sampler();
  }

 private:
  Fault& fault_;
};

Scene fizz() {
  Scene scene;
  scene.domain.size = {0.06, 0.06, 0.06};
  scene.domain.resolution = 12;
  scene.stillPool = {true, 0.04};
  scene.time.maxDt = scene.time.minDt = 0.01;
  BubbleSourceSpec source;
  source.shape = test::boxShape({0.02, 0.005, 0.02}, {0.04, 0.02, 0.04});
  source.rate = 2000;
  scene.bubbleSources = {source};
  return scene;
}

std::string bytesOf(SimulationState state) {
  ArchiveWriter writer;
  archive(writer, state);
  return writer.bytes;
}

class StepFailures : public testing::Test {
 protected:
  StepFailures() {
    simulation_.step(0.01);
    before_ = bytesOf(simulation_.state());
  }
  /// The same step of a run that nothing happened to.
  std::string undisturbed() {
    Simulation twin(scene_);
    twin.step(0.01), twin.step(0.01);
    return bytesOf(twin.state());
  }

  Scene scene_ = fizz();
  Fault fault_;
  Simulation simulation_{scene_, std::make_unique<FaultyLiquid>(scene_, fault_)};
  std::string before_;
};

/// A step asks three times: how much gas is immersed, where sources may blow, and what moves the foam. At the
/// last the bubbles of the step are born and booked.
TEST_F(StepFailures, OfAnyKindLeaveTheStateAsItWas) {
  for (int question = 1; question <= 3; ++question) {
    fault_ = {question, [] { throw std::bad_alloc(); }};
    EXPECT_THROW(simulation_.step(0.01), std::bad_alloc) << question;
    EXPECT_EQ(bytesOf(simulation_.state()), before_) << question;
  }
  fault_ = {4, [] { throw std::bad_alloc(); }};
  simulation_.step(0.01);
  EXPECT_EQ(fault_.countdown, 1) << "a step asks more often than this test knows";
  EXPECT_EQ(bytesOf(simulation_.state()), undisturbed());
}

TEST_F(StepFailures, OfTheNumbersAreTriedAgainAtHalfTheLength) {
  fault_ = {3, [] { throw foam::NumericalFailure("no number"); }};
  const StepReport report = simulation_.step(0.01);
  EXPECT_EQ(report.halvings, 1);
  EXPECT_EQ(report.dt, 0.005);
  EXPECT_EQ(simulation_.time(), 0.015);
  EXPECT_NEAR(report.gas.imbalance(), 0, 1e-12 * report.gas.entered());
}

/// What the module knows, and when it was; the last try is a sixteenth of the step.
TEST_F(StepFailures, OfTheNumbersThatGoOnAreThrownWithTheirStep) {
  fault_ = {3, [&] {
              fault_.countdown = 3;
              throw foam::NumericalFailure("no number");
            }};
  try {
    simulation_.step(0.01);
    FAIL() << "no exception";
  } catch (const foam::NumericalFailure& failure) {
    EXPECT_STREQ(failure.what(),
                 "step 2 from t = 0.01 s failed, halved 4 times to dt = 0.000625 s: no number");
  }
  EXPECT_EQ(bytesOf(simulation_.state()), before_);
}

}  // namespace
}  // namespace spume::coupling
