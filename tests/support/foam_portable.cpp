// Prints the sample as a program for any x86-64 finds it: numbers of both parts, then these.
#include <cstdio>

#include "tests/support/foam_sample.h"

int main() {
  const spume::foam::test::FoamSample sample;
  std::printf("%zu %zu\n", sample.cells.size(), sample.motion.size());
  for (const auto* part : {&sample.cells, &sample.motion})
    for (const double value : *part) std::printf("%.17g\n", value);
  return 0;
}
