#include <catch2/catch.hpp>

#include <set>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "support/temp_folder.h"
#include "tf/formats/tf_json.h"
#include "tf/presets.h"
#include "tf/tf_range.h"

using namespace pellucid;

TEST_CASE("every preset is valid, named, and its features show", "[tf][presets]") {
    REQUIRE(tfPresets().size() == embeddedPresets().size());
    std::set<std::string> names, groups;
    for (const TfPreset& preset : tfPresets()) {
        INFO(preset.name);
        CHECK_NOTHROW(preset.tf.validate());
        CHECK(names.insert(preset.name).second);
        groups.insert(preset.group);
        CHECK_FALSE(preset.title.empty());
        CHECK(preset.about.ends_with('.'));
        REQUIRE_FALSE(preset.tf.features.empty());
        for (const double peak : featureOpacities(preset.tf)) CHECK(peak > 0);
        CHECK(tfFromPresetSpec("preset:" + preset.name) == preset.tf);
        // Hounsfield units are of CT alone; other modalities have no scale that a preset could be written for.
        CHECK(preset.tf.range.has_value() == (preset.group == "CT"));
    }
    CHECK(groups == std::set<std::string>{"CT", "MR", "Simulation"});
}

TEST_CASE("bone presets draw bone, and skin and air where they say so", "[tf][presets]") {
    // 1000 HU is compact bone, 0 HU water, −100 HU fat, −1000 HU air (thesis table 3.1 has 700 to 3000 for bone).
    const auto opacityAt = [](const char* name, double hu) {
        const TransferFunction tf = *tfFromPresetSpec(name);
        return tf.opacity((hu - tf.range->lo) / (tf.range->hi - tf.range->lo));
    };
    for (const char* name : {"preset:ct-bone", "preset:ct-skin-bone"}) {
        CHECK(opacityAt(name, 1000) > 0.3);
        CHECK(opacityAt(name, 60) == 0);
        CHECK(opacityAt(name, -1000) == 0);
    }
    CHECK(opacityAt("preset:ct-bone", -200) == 0);
    CHECK(opacityAt("preset:ct-skin-bone", -200) > 0.01);
    CHECK(opacityAt("preset:ct-lung", -850) > opacityAt("preset:ct-lung", 1000) / 10);
    CHECK(opacityAt("preset:ct-soft-tissue", 45) > opacityAt("preset:ct-soft-tissue", 700));
}

TEST_CASE("an unknown preset is told with those that there are", "[tf][presets]") {
    CHECK_FALSE(tfFromPresetSpec("tents:3"));
    try {
        tfFromPresetSpec("preset:bones");
        FAIL("it was taken");
    } catch (const UsageError& e) {
        CHECK(std::string(e.what()).find("ct-bone") != std::string::npos);
    }
}

TEST_CASE("a kept preset comes back with its title and opacities", "[tf][presets]") {
    const test::TempFolder folder;
    TransferFunction tf = *tfFromPresetSpec("preset:ct-vessels");
    tf.points[1].opacity = 0.123;
    const std::string path = folder.path("mine.tf.json");
    writePreset(tf, "Mine, ü", path);
    const TfPreset back = readPreset(path);
    CHECK(back.name == "mine");
    CHECK(back.title == "Mine, ü");
    CHECK(back.group.empty()); // that was of the one it was made from
    CHECK(back.about.empty());
    CHECK(back.tf.points == tf.points);
    CHECK(back.tf.features == tf.features);
    CHECK(back.tf.range == tf.range);
}

TEST_CASE("colours or opacities alone are taken of another transfer function", "[tf][presets]") {
    const TransferFunction mine = tents(3, 0.4), other = ramp(6);
    const TransferFunction colored = taken(mine, other, Take::Colors);
    REQUIRE(colored.points.size() == mine.points.size());
    for (std::size_t i = 0; i < mine.points.size(); ++i) {
        CHECK(colored.points[i].opacity == mine.points[i].opacity);
        CHECK(colored.points[i].x == mine.points[i].x);
        CHECK(colored.points[i].color == other.color(mine.points[i].x));
    }
    // A feature has the colour of its peak: of tent i, that is at (i + ½)/3.
    for (std::size_t f = 0; f < 3; ++f) CHECK(colored.features[f].color == other.color(mine.points[3 * f + 1].x));
    const TransferFunction shaped = taken(mine, other, Take::Opacities);
    for (const double s : {0.05, 0.2, 0.51, 0.9}) CHECK(shaped.opacity(s) == Approx(other.opacity(s)));
    CHECK(shaped.points[2].color == mine.color(other.points[2].x));
    CHECK(taken(mine, other, Take::All) == other);
}
