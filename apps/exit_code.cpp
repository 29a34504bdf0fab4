#include "apps/exit_code.h"

#include "apps/stop_request.h"
#include "coupling/errors.h"
#include "fluid/errors.h"
#include "foam/errors.h"

namespace spume::apps {
namespace {

template <typename... Errors>
bool isOneOf(const std::exception& error) {
  return (... || (dynamic_cast<const Errors*>(&error) != nullptr));
}

}  // namespace

ExitCode exitCodeOf(const std::exception& error) {
  if (const auto* stopped = dynamic_cast<const Stopped*>(&error)) return stopped->code();
  if (isOneOf<coupling::SceneError, fluid::InvalidParameter, foam::InvalidParameter>(error)) return kUsage;
  if (isOneOf<coupling::FileError>(error)) return kInputOutput;
  return kFailed;  // numerical failures among them
}

}  // namespace spume::apps
