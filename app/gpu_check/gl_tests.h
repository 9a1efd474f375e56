// The tests of tests/gl that are linked into this program.
#pragma once

#include <string>
#include <vector>

#include "json.h"

namespace pellucid::gpu_check {

struct GlTest {
    std::string name;
    bool slow = false; ///< left out by --quick: tagged [accuracy], [orbit] or [slow]
};

/// In the order of their sources; without those that need files, which are tagged [real] or [files].
std::vector<GlTest> glTests();

/// Runs the test of this name here: {"passed", "failures"}. Once per process.
Json runGlTest(const std::string& name);

} // namespace pellucid::gpu_check
