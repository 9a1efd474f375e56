// --ground and its details: a height field under the volume.
#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "image_io/image_file.h"

using namespace pellucid;
using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

/// From above, over red.
const Words kSmall{"render", "sample:shells",  "--sample-size", "16",    "--tf",         "tents:3:0.1", "--view",
                   "0,90",   "--orthographic", "--size",        "40x40", "--background", "1,0,0",       "--engine",
                   "cpu"};

} // namespace

TEST_CASE("render draws a ground from any one-layer file", "[cli][ground]") {
    const Workshop w;
    w.write("heights.raw", std::string("\0\0\0\0\0\0", 6)); // 3 × 2 of 0: sea everywhere
    const Words ground{"--ground", "heights.raw", "--ground-raw", "3,2,u8", "--ground-relief", "0.5"};
    CHECK(w.run(kSmall + ground + Words{"--out", "sea.png"}).status == 0);
    CHECK(w.run(kSmall + Words{"--out", "none.png"}).status == 0);
    const Image sea = readImage(w.path("sea.png").string()), none = readImage(w.path("none.png").string());
    // The ground reaches to the edge of the box, where the shells do not.
    int blue = 0, red = 0;
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x) {
            const float *with = sea.pixel(x, y), *without = none.pixel(x, y);
            blue += with[2] > with[0] && without[0] > 0.99f ? 1 : 0;
            red += with[0] > 0.99f ? 1 : 0;
        }
    CHECK(blue > 100);
    CHECK(red > 300); // beside the box
    // Its own colours, and a session's ground that is not wanted.
    CHECK(w.run(kSmall + ground + Words{"--ground-map", "grey", "--out", "grey.png"}).status == 0);
    CHECK(readImage(w.path("grey.png").string()).rgba != sea.rgba);
    CHECK(w.run(kSmall + Words{"--ground", "none", "--out", "again.png"}).status == 0);
    CHECK(readImage(w.path("again.png").string()).rgba == none.rgba);
}

TEST_CASE("what cannot be a ground is told with its option", "[cli][ground]") {
    const Workshop w;
    w.write("heights.raw", "abcdef");
    const auto refused = [&](const Words& options, const std::string& said) {
        const Outcome o = w.run(kSmall + Words{"--out", "p.png"} + options);
        INFO(o.err);
        CHECK(o.status == 2);
        CHECK(o.err.find(said) != std::string::npos);
        CHECK(!w.has("p.png"));
    };
    refused({"--ground-relief", "0.5"}, "--ground-relief");
    refused({"--ground", "heights.raw", "--ground-raw", "3,2"}, "--ground-raw");
    refused({"--ground", "heights.raw", "--ground-raw", "3,2,u9"}, "--ground-raw");
    refused({"--ground", "heights.raw", "--ground-map", "mud"}, "terrain");
    refused({"--ground", "heights.raw", "--ground-relief", "1.5"}, "--ground-relief");
    refused({"--ground", "heights.raw", "--ground-scale", "0"}, "--ground-scale");
    const Outcome layers = w.run(kSmall + Words{"--ground", "sample:shells", "--out", "p.png"});
    CHECK(layers.status == 1);
    CHECK(layers.err.find("one layer") != std::string::npos);
    // The picture must not replace its own ground.
    const Outcome same = w.run(kSmall + Words{"--ground", "heights.png", "--out", "heights.png"});
    CHECK(same.status != 0);
}
