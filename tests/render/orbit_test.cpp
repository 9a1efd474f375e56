#include <catch2/catch.hpp>

#include "support/orbit_check.h"

using namespace pellucid;
using namespace pellucid::test;

TEST_CASE("W does not jump where the cpu engine changes its sweep axis", "[visibility][cpu][orbit]") {
    checkOrbits([](auto volume) { return makeCpuEngine(volume); }, PELLUCID_SHARED_DIR);
}
