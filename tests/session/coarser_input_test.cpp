// What is measured, of a coarser copy.
#include <catch2/catch.hpp>

#include "session/coarser_input.h"
#include "session/workspace.h"

using namespace pellucid;

namespace {

Scene shells(int size) {
    VolumeSource source;
    source.path = "sample:shells";
    source.sampleSize = size;
    SceneInputs inputs;
    inputs.session = sessionOf(source);
    inputs.tf = "tents:3";
    return openScene(inputs);
}

} // namespace

TEST_CASE("a coarser input keeps lengths, window and place", "[session][space]") {
    const MeasureInput whole = measureInput(shells(33));
    CHECK(coarserInput(whole, 1) == whole);
    const MeasureInput coarse = coarserInput(whole, 2);
    const Geometry &a = whole.volume->geometry(), &b = coarse.volume->geometry();
    CHECK(b.dims == Int3(17)); // ⌈33/2⌉
    CHECK(b.spacing == 2.0 * a.spacing);
    CHECK(b.d0() == a.d0());
    CHECK(coarse.volume->range() == whole.volume->range());
    CHECK(coarse.tf == whole.tf);
    CHECK(coarse.view == whole.view);
    // Its figures are those of the whole, to what halving does to shells some voxels thick.
    Workspace workspace;
    const Measures full = workspace.measure(whole), half = workspace.measure(coarse);
    for (std::size_t f = 0; f < 3; ++f) CHECK(half.features[f].vws == Approx(full.features[f].vws).margin(0.08));
}
