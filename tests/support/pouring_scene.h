#pragma once

#include <string>

namespace spume::apps::test {

/// A jet into a pool, small enough for a test and fast enough to catch air.
inline const std::string kPour =
    "[domain]\nsize = [0.06, 0.06, 0.06]\nresolution = 16\n"
    "[output]\npreview = false\ncheckpoint_every = 2\n"
    "[coupling.entrainment]\nblock_size = 0.01\n"
    "[[liquid_body]]\nname = \"pool\"\nshape = \"box\"\nlower = [-0.01, -0.01, -0.01]\nupper = [0.07, 0.02, "
    "0.07]\n"
    "[[inflow]]\nname = \"jet\"\ncentre = [0.025, 0.05, 0.03]\ndirection = [0, -1, 0]\nradius = 0.008\nspeed "
    "= 1.2\n";

}  // namespace spume::apps::test
