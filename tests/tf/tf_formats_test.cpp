// Files of other programs: what is written is read back, and what others write is read right or refused in words.
#include <catch2/catch.hpp>

#include <algorithm>
#include <clocale>
#include <cmath>
#include <filesystem>
#include <random>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "support/temp_folder.h"
#include "tf/formats/foreign_file.h"
#include "tf/formats/tf_curves.h"
#include "tf/formats/tf_file.h"
#include "tf/formats/tf_json.h"
#include "tf/formats/tf_parts.h"
#include "tf/formats/tf_snippets.h"
#include "tf/shapes.h"
#include "tf/shown_tf.h"

using namespace pellucid;
using Catch::Contains;
using nlohmann::json;

namespace {

ReadTf readOf(const std::string& format, const std::string& text, const std::string& part = {}) {
    return tfFormatNamed(format).read(ForeignFile("a", text, part));
}

std::string messageOf(const std::string& format, const std::string& text, const std::string& part = {}) {
    try {
        readOf(format, text, part);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

bool says(const std::vector<std::string>& notices, const std::string& words) {
    return std::ranges::any_of(notices, [&](const std::string& n) { return n.find(words) != std::string::npos; });
}

Geometry gridLike(Int3 dims, Vec3 spacing) {
    Geometry g;
    g.dims = dims;
    g.spacing = spacing;
    return g;
}

/// Two tents, one with a step and colours of its own, over −1000 to 3000.
TransferFunction sample() {
    TransferFunction tf = tents(2, 0.4);
    tf.points = {{0.1, 0, {1, 0.5, 0}, true, {}}, {0.25, 0.3, {1, 0, 0}, false, {}}, {0.25, 0.6, {0, 1, 0}, false, {}},
                 {0.4, 0, {0, 1, 0}, true, {}},   {0.5, 0, {0, 0.2, 1}, true, {}},   {0.7, 0.05, {0, 0, 1}, false, {}},
                 {0.9, 0, {1, 1, 1}, true, {}}};
    tf.features = deriveFeatures(tf);
    tf.range = ValueRange{-1000, 3000};
    return tf;
}

} // namespace

TEST_CASE("each format writes what it reads back as the same curves", "[tf][formats]") {
    const TransferFunction tf = sample();
    const Geometry g = gridLike({120, 100, 80}, {0.5, 0.6, 1.5});
    for (const TfFormat& format : tfFormats()) {
        INFO(format.name);
        const std::string name = format.name;
        const WrittenTf written = writtenTf(format, {tf, {}, g, "mine"});
        const ReadTf read = format.read(ForeignFile("a", written.text));
        const TransferFunction back = withOpacitiesPer(read.tf, g.d0() / read.length.inWorld(g));
        back.validate();
        const bool hasRange = name != "imagevis3d" && name != "itksnap";
        CHECK(read.tf.range.has_value() == hasRange);
        if (hasRange) CHECK(*read.tf.range == *tf.range);
        CHECK(read.positions.has_value() == !hasRange);
        const bool hasOpacities = name != "vtkjs" && name != "paraview-xml";
        const bool hasTable = name == "niivue" || name == "imagevis3d"; // steps have the width of an entry
        const double colorMargin = name == "niivue" ? 0.02 : name == "itksnap" || name == "voreen" ? 0.003 : 1e-3;
        const double opacityMargin = name == "niivue" ? 0.012 : 0.008; // of two conversions and 8 bits
        for (int i = 0; i <= 400; ++i) {
            const double x = i / 400.0;
            if (std::abs(x - 0.25) < (hasTable ? 0.006 : 1e-5)) continue;
            INFO(x);
            if (hasOpacities) CHECK(back.opacity(x) == Approx(tf.opacity(x)).margin(opacityMargin));
            CHECK(back.color(x).g == Approx(tf.color(x).g).margin(colorMargin));
        }
    }
}

TEST_CASE("what is lost is said", "[tf][formats]") {
    TransferFunction tf = sample();
    tf.points[5].opacity = 0.0005; // over paths of another length still below a step of 8 bits
    tf = withFeatureHidden(tf, 0, true);
    const Geometry g = gridLike(Int3(64), Vec3(1));
    for (const TfFormat& format : tfFormats().subspan(1)) {
        INFO(format.name);
        const std::vector<std::string> losses = writtenTf(format, {tf, {}, g, "mine"}).losses;
        CHECK(says(losses, "features are not stored"));
        CHECK(says(losses, "an eye hides"));
        const std::string name = format.name;
        CHECK(says(losses, "below 0.002") == (name == "voreen" || name == "niivue" || name == "itksnap"));
        CHECK(says(losses, "no data range:") == (name == "imagevis3d" || name == "itksnap"));
        CHECK(says(losses, "colours only") == (name == "vtkjs" || name == "paraview-xml"));
        CHECK(!says(losses, "is known"));
        TransferFunction anywhere = tf;
        anywhere.range.reset();
        const std::vector<std::string> more = writtenTf(format, {anywhere, {}, {}, "mine"}).losses;
        CHECK(says(more, "no data range is known"));
        CHECK(says(more, "no volume is known"));
    }
    CHECK(writtenTf(pellucidTfFormat(), {tf, {}, g, ""}).losses.empty());
}

TEST_CASE("programs that lay a curve over the data get it for all values of the data", "[tf][formats]") {
    TransferFunction ramp; // holds beyond its ends
    ramp.points = {{0, 0.2, {1, 0, 0}, false, {}}, {1, 0.6, {0, 0, 1}, false, {}}};
    ramp.range = ValueRange{-1000, 3000};
    const TransferFunction hidden = withFeatureHidden(sample(), 0, true); // −600 to 600
    const Geometry g = gridLike(Int3(64), Vec3(1));
    for (const char* name : {"itksnap", "imagevis3d"})
        for (const TransferFunction& tf : {sample(), ramp, hidden})
            for (const ValueRange& data : {ValueRange{-2000, 6000}, ValueRange{-500, 500}}) {
                INFO(name << " " << data.lo);
                const TfFormat& format = tfFormatNamed(name);
                const WrittenTf written = writtenTf(format, {tf, {}, g, "mine", data});
                CHECK(says(written.losses, data.lo == -2000 ? "all values of the data, -2000 to 6000"
                                                            : "all values of the data, -500 to 500"));
                CHECK_FALSE(says(written.losses, "assumed"));
                const ReadTf read = format.read(ForeignFile("a", written.text));
                CHECK(read.spansData);
                const TransferFunction seen = shownTf(tf);
                for (double value = data.lo; value <= data.hi; value += 10) {
                    if (value == 0) continue; // the step
                    INFO(value);
                    const double x = (value - data.lo) / (data.hi - data.lo);
                    const double own = std::clamp((value + 1000) / 4000, 0.0, 1.0);
                    // Half a step of 8 bits is 0.002; an entry of the table at most 2 values wide.
                    CHECK(read.tf.opacity(x) == Approx(seen.opacity(own)).margin(0.003));
                    if (seen.opacity(own) > 0) CHECK(read.tf.color(x).b == Approx(seen.color(own).b).margin(0.005));
                }
            }
    // Values of one frame are called so; in a format with a range of its own nobody needs them.
    TfToWrite ofFrame{ramp, {}, g, "mine", ValueRange{-500, 500}};
    ofFrame.sayDataIsOf("frame 3");
    CHECK(says(writtenTf(itkSnapFormat(), ofFrame).losses,
               "all values of the data, -500 to 500, the range of frame 3 alone: other frames were not read"));
    CHECK_FALSE(says(writtenTf(paraViewFormat(), ofFrame).losses, "frame 3"));
    // Without the data the curve is written as it is, and that is told.
    const WrittenTf unknown = writtenTf(itkSnapFormat(), {ramp, {}, {}, ""});
    CHECK(says(unknown.losses, "assumed to be -1000 to 3000; name a volume"));
    CHECK(readOf("itksnap", unknown.text).tf.opacity(0.5) == Approx(0.4).margin(0.002));
    ramp.range.reset();
    CHECK(says(writtenTf(itkSnapFormat(), {ramp, {}, {}, ""}).losses, "which are assumed to be those at 0 and 1"));

    // Opened they are put on the data again; what other programs stretch over a window is not.
    Geometry line;
    line.dims = Int3(3, 1, 1);
    const Volume small(line, Samples(std::vector<std::uint8_t>{10, 40, 90}));
    CHECK(forVolume(readOf("itksnap", unknown.text), small).range == ValueRange{10, 90});
    CHECK_FALSE(forVolume(readOf("niivue", R"({"R": [0, 255], "G": [0, 0], "B": [0, 0]})"), small).range);
}

TEST_CASE("a file without a range is told with its positions and the values that they are put on", "[tf][formats]") {
    const Geometry g = gridLike(Int3(64), Vec3(1));
    const ReadTf preset = readOf("paraview", R"([{"Name": "a", "RGBPoints": [-1, 0, 0, 0, 1, 1, 1, 1]}])");
    CHECK(preset.positions == ValueRange{-1, 1});
    CHECK(says(openingNotices(preset, g, ValueRange{40, 80}), "its positions -1 to 1 are put on the values 40 to 80"));
    CHECK(says(openingNotices(preset, g), "its positions -1 to 1 become the ends"));
    const ReadTf placed = readOf("paraview", R"([{"Name": "a", "RGBPoints": [-1, 0, 0, 0, 2, 1, 1, 1]}])");
    CHECK_FALSE(says(openingNotices(placed, g, ValueRange{40, 80}), "no data range"));
}

TEST_CASE("opacities are written for the length that a program takes them for", "[tf][formats]") {
    TransferFunction tf;
    tf.points = {{0, 0.5, {1, 1, 1}, false, {}}, {1, 0.5, {1, 1, 1}, false, {}}};
    tf.range = ValueRange{0, 10};
    const Geometry g = gridLike(Int3(101), Vec3(2)); // d0 = 2
    const auto first = [&](const char* name) {
        const TfFormat& format = tfFormatNamed(name);
        return format.read(ForeignFile("a", writtenTf(format, {tf, {}, g, ""}).text)).tf.points.front().opacity;
    };
    CHECK(first("paraview") == Approx(1 - std::pow(0.5, std::sqrt(3.0)))); // 2·√3 of 2
    CHECK(first("slicer") == 0.5);                                         // its unit distance is 2
    CHECK(first("slicer-vp") == Approx(1 - std::sqrt(0.5)));               // 1 mm of 2
    CHECK(first("slicer-xml") == Approx(1 - std::sqrt(0.5)));
    CHECK(first("mitk") == Approx(1 - std::sqrt(0.5)));
    CHECK(first("inviwo") == Approx(1 - std::pow(0.5, 202.0 / 150 / 2)));
    CHECK(first("voreen") == Approx(1 - std::pow(0.5, 202.0 / 200 / 2)).margin(0.5 / 255));
    CHECK(first("csv") == 0.5);
    // What was written is opened as what it was.
    const test::TempFolder folder;
    for (const char* file : {"a.paraview.json", "a.vp.json", "a.vp", "a.tfi", "a.itf", "a.mitk.xml", "a.tf.csv"}) {
        INFO(file);
        writeTfFile({tf, {}, g, "a"}, folder.path(file));
        CHECK(forVolume(openTfFile(folder.path(file)), g).opacity(0.5) == Approx(0.5).margin(0.003));
    }
}

TEST_CASE("a slab hides what the power law says, whatever the program", "[tf][formats]") {
    // A block of thickness 20 at a = 0.05 for U = 1 lets 0.95^20 through: opacity 0.6415; for U = 5 it is 1 − 0.95^4 =
    // 0.1855; at a = 0.2 for U = 20 it is 0.2.
    const auto slab = [](double a, double unit) {
        const std::string alpha = std::to_string(a);
        const std::string property = R"({"volumeProperties": [{"components": [{"scalarOpacityUnitDistance": )" +
                                     std::to_string(unit) + R"(, "scalarOpacity": {"points": [{"x": 0, "y": )" + alpha +
                                     R"(}, {"x": 1, "y": )" + alpha + "}]}}]}]}";
        const TransferFunction tf = forVolume(readOf("slicer", property), gridLike(Int3(20), Vec3(1)));
        return opacityPer(tf.opacity(0.5), 20); // 20 reference lengths of 1
    };
    CHECK(slab(0.05, 1) == Approx(0.6415).margin(1e-4));
    CHECK(slab(0.05, 5) == Approx(0.1855).margin(1e-4));
    CHECK(slab(0.2, 20) == Approx(0.2).margin(1e-4));
}

TEST_CASE("presets of ParaView are read as it writes them", "[tf][formats]") {
    const std::string list = R"([
        {"Name": "first", "ColorSpace": "CIELAB", "RGBPoints": [0, 0, 0, 0, 1, 1, 1, 1,], "Source": "somebody"},
        {"Name": "second", "ColorSpace": "RGB", "UseLogScale": 1,
         "RGBPoints": [1, 0, 0, 0, 100, 1, 1, 1], "Points": [1, 0, 0.5, 0, 100, 1, 0.5, 0]},
    ])"; // commas behind the last, as in the presets that come with it
    const ReadTf first = readOf("paraview", list);
    CHECK(says(first.notices, "the first of 2 presets, 'first'"));
    CHECK(says(first.notices, "colours only"));
    CHECK(first.positions == ValueRange{0, 1});
    CHECK(!first.tf.range); // 0 to 1 is whatever the range is
    CHECK(first.length.kind == OpacityLength::Kind::ParaView);
    CHECK_THAT(first.tf.extraJson, Contains("somebody"));

    const ReadTf second = readOf("paraview", list, "second");
    CHECK(second.tf.range == ValueRange{1, 100});
    CHECK(second.tf.opacity(9.0 / 99) == Approx(0.5).margin(0.003)); // 10 is half way from 1 to 100
    CHECK(says(second.notices, "logarithmic scale has been converted"));
    CHECK_THAT(messageOf("paraview", list, "third"), Contains("no preset 'third'") && Contains("first, second"));

    const auto one = [](const std::string& keys) { return R"([{"Name": "a", )" + keys + "}]"; };
    CHECK_THAT(messageOf("paraview", one(R"("IndexedColors": [1, 0, 0], "Annotations": [0, "bone"])")),
               Contains("categories"));
    CHECK_THAT(messageOf("paraview", one(R"("ColorSpace": "XYZ", "RGBPoints": [0, 0, 0, 0])")),
               Contains("no colour space 'XYZ'"));
    CHECK_THAT(messageOf("paraview", one(R"("RGBPoints": [0, 0, 0])")), Contains("multiple of 4"));
    CHECK_THAT(messageOf("paraview", one(R"("RGBPoints": [])")), Contains("no points"));
    CHECK_THAT(messageOf("paraview", one(R"("RGBPoints": [0, 0, 0, 0], "Points": [0, 1, 2, 0])")),
               Contains("midpoint"));
    CHECK_THAT(messageOf("paraview", one(R"("RGBPoints": [0, 0, "NaN", 0])")), Contains("a finite number"));
    CHECK(readOf("paraview", one(R"("RGBPoints": [5, 0.5, 0, 0], "Points": [5, 0.25, 0.5, 0])")).tf.opacity(0.7) ==
          0.25);
    const ReadTf log = readOf("paraview", one(R"("UseLogScale": 1, "RGBPoints": [-2, 0, 0, 0, 8, 1, 1, 1])"));
    CHECK(says(log.notices, "cannot begin at 0"));
    CHECK(log.tf.color(0.5).r == Approx(0.5));
    // The later of two points at one x takes the place of the earlier.
    const ReadTf twice = readOf("paraview", one(R"("RGBPoints": [0, 0, 0, 0, 5, 1, 0, 0, 5, 0, 1, 0, 10, 0, 0, 0])"));
    CHECK(twice.tf.color(0.25).g == Approx(0.5));
    CHECK(twice.tf.color(0.25).r == 0);
}

TEST_CASE("what a preset has besides is written again", "[tf][formats]") {
    const ReadTf read = readOf(
        "paraview", R"([{"Name": "a", "RGBPoints": [0, 0, 0, 0, 9, 1, 1, 1], "Groups": ["CT"], "License": "CC0"}])");
    const json again = json::parse(writtenTf(paraViewFormat(), {read.tf, {}, {}, "b"}).text);
    CHECK(again[0]["Groups"][0] == "CT");
    CHECK(again[0]["License"] == "CC0");
    CHECK(again[0]["Name"] == "b");
}

TEST_CASE("volume properties of 3D Slicer are read in all three files", "[tf][formats]") {
    const std::string alpha = "6 -1000 0 100 0.5 900 0", color = "8 -1000 1 0 0 900 0 0 1", gradient = "4 0 0.25 50 1";
    const std::string lines = "1\n1\n0.9\n0.1\n0.2\n10\n" + alpha + "\n" + gradient + "\n" + color + "\n";
    const std::string scene =
        R"(<MRML><VolumeProperty name="CT-A" interpolation="1" shade="1" ambient="0.1" diffuse="0.9"
        specular="0.2" specularPower="10" scalarOpacity=")" +
        alpha + R"(" gradientOpacity=")" + gradient + R"(" colorTransfer=")" + color +
        R"(" effectiveRange="-250.0.0 1550.0"/><VolumeProperty name="CT-B"/></MRML>)";
    for (const ReadTf& read : {readOf("slicer-vp", lines), readOf("slicer-xml", scene)}) {
        CHECK(read.tf.range == ValueRange{-1000, 900});
        CHECK(read.length == OpacityLength{OpacityLength::Kind::World, 1});
        CHECK(read.tf.opacity(1100.0 / 1900) == Approx(0.5));
        CHECK(says(read.notices, "opacity by gradient is kept"));
        CHECK(read.tf.features.size() == 1);
        // Light and gradient opacities come through, whichever of the files is written.
        const json again = json::parse(writtenTf(slicerFormat(), {read.tf, {}, {}, ""}).text);
        const json& component = again["volumeProperties"][0]["components"][0];
        CHECK(component["shade"] == true);
        CHECK(component["lighting"]["specularPower"] == 10.0);
        CHECK(component["gradientOpacity"]["points"][0]["y"] == 0.25);
        CHECK(component["disableGradientOpacity"] == false);
        const ReadTf back = readOf("slicer", again.dump());
        CHECK_THAT(writtenTf(slicerVpFormat(), {back.tf, {}, {}, ""}).text, Contains("\n4 0 0.25 50 1\n"));
    }
    CHECK(says(readOf("slicer-xml", scene).notices, "first of 2 presets"));
    CHECK_THAT(messageOf("slicer-xml", scene, "CT-B"), Contains("no points") && Contains("'CT-B'"));
    CHECK_THAT(messageOf("slicer-vp", "1\n1\n0.9\n"), Contains("3 of 9 lines"));
    CHECK_THAT(messageOf("slicer-vp", "1\n1\n0.9\n0.1\n0.2\n10\n4 0 0 1\n4 0 1 1 1\n8 0 1 0 0 1 1 1 1\n"),
               Contains("'4' numbers but has 3"));
    CHECK_THAT(messageOf("slicer-vp", "1\n1\n0,9\n0.1\n0.2\n10\n4 0 0 1 1\n4 0 1 1 1\n8 0 1 0 0 1 1 1 1\n"),
               Contains("'0,9' is not a number") && Contains("line 3"));
    CHECK_THAT(messageOf("slicer-vp", "1\n1\n1\n1\n1\n1\n3 0 0 1\n4 0 1 1 1\n4 0 1 0 0\n"), Contains("multiple of 2"));
}

TEST_CASE("each of 3D Slicer's presets in a file is opened by its name", "[tf][formats]") {
    const test::TempFolder folder;
    const std::string file = folder.write("presets.xml", R"(<?xml version="1.0" encoding="UTF-8"?>
<MRML version="4.0" userTags="">
 <VolumeProperty id="vtkMRMLVolumePropertyNode1" name="CT-One" references="" interpolation="1" shade="1" diffuse="0.9"
  ambient="0.1" specular="0.2" specularPower="10" scalarOpacity="8 -3024 0 60 0 120 0.4 3000 0.4"
  gradientOpacity="4 0 1 255 1" colorTransfer="8 -3024 0 0 0 3000 1 0.5 0" effectiveRange="-3024 3000" selectable="true"/>
 <VolumeProperty id="vtkMRMLVolumePropertyNode2" name="MR #2" references="" interpolation="0" shade="0" diffuse="0.6"
  ambient="0.3" specular="0.1" specularPower="5" scalarOpacity="6 0 0 50 0.1 200 0.7"
  gradientOpacity="6 0 0 10 0.5 80 1" colorTransfer="8 0 0.2 0.2 0.2 200 1 1 1" effectiveRange="0 -1"/>
 <VolumeProperty id="vtkMRMLVolumePropertyNode3" name="Third" scalarOpacity="8 0 0 100 0 100 0.5 255 0.5"
  colorTransfer="8 0 1 0 0 255 0 0 1"/>
</MRML>
)");
    CHECK(isTfFile(file));
    CHECK(tfNamesIn(file) == std::vector<std::string>{"CT-One", "MR #2", "Third"});
    CHECK(says(openTfFile(file).notices, "the first of 3 presets, 'CT-One'"));

    const ReadTf one = openTfFile(file + "#CT-One");
    CHECK_FALSE(says(one.notices, "the first of"));
    CHECK_FALSE(says(one.notices, "opacity by gradient")); // 1 throughout
    REQUIRE(one.tf.range == ValueRange{-3024, 3000});
    const auto at = [](const ReadTf& read, double value) {
        return (value - read.tf.range->lo) / (read.tf.range->hi - read.tf.range->lo);
    };
    CHECK(one.tf.opacity(at(one, 90)) == Approx(0.2)); // half way from 60 to 120
    CHECK(one.tf.opacity(at(one, 2000)) == Approx(0.4));
    CHECK(one.tf.color(at(one, -12)).r == Approx(0.5)); // half way from −3024 to 3000
    CHECK(one.tf.color(at(one, -12)).g == Approx(0.25));

    const ReadTf two = openTfFile(file + "#MR #2");
    REQUIRE(two.tf.range == ValueRange{0, 200});
    CHECK(two.tf.opacity(at(two, 125)) == Approx(0.4)); // half way from 0.1 to 0.7
    CHECK(two.tf.color(at(two, 100)).b == Approx(0.6));
    CHECK(says(two.notices, "opacity by gradient is kept"));
    // Of 1 mm: of voxels 0.5 mm apart 1 − √0.6.
    CHECK(forVolume(two, gridLike(Int3(8), Vec3(0.5))).opacity(at(two, 125)) ==
          Approx(1 - std::sqrt(0.6)).margin(0.002));
    const std::string again = writtenTf(slicerXmlFormat(), {two.tf, {}, {}, "again"}).text;
    CHECK_THAT(again, Contains("gradientOpacity=\"6 0 0 10 0.5 80 1\"") && Contains("ambient=\"0.3\"") &&
                          Contains("interpolation=\"0\"") && Contains("shade=\"0\""));

    const ReadTf third = openTfFile(file + "#Third");
    CHECK(third.tf.opacity(at(third, 99.9)) == Approx(0).margin(1e-9));
    CHECK(third.tf.opacity(at(third, 100)) == 0.5);
    CHECK(third.tf.color(at(third, 127.5)).b == Approx(0.5));
    CHECK_THROWS_WITH(openTfFile(file + "#Fourth"), Contains("CT-One, MR #2, Third"));
}

TEST_CASE("presets without a name and of the same name are told apart", "[tf][formats]") {
    const auto preset = [](const std::string& name, int hi) {
        return R"({"Name": ")" + name + R"(", "RGBPoints": [0, 0, 0, 0, )" + std::to_string(hi) + ", 1, 1, 1]}";
    };
    const test::TempFolder folder;
    const std::string file =
        folder.write("a#b.json", "[" + preset("a", 10) + ", " + preset("", 20) + ", " + preset("a", 30) + ", " +
                                     preset("c#d", 40) + R"(, {"Name": "labels", "IndexedColors": [1, 0, 0]}])");
    CHECK(tfNamesIn(file) == std::vector<std::string>{"a", "preset 2", "a (2)", "c#d", "labels"});
    CHECK(loadTf(file).range == ValueRange{0, 10});
    CHECK(loadTf(file + "#a").range == ValueRange{0, 10});
    CHECK(loadTf(file + "#preset 2").range == ValueRange{0, 20});
    CHECK(loadTf(file + "#a (2)").range == ValueRange{0, 30});
    CHECK(loadTf(file + "#c#d").range == ValueRange{0, 40});
    // Who is called "a (2)" stays so.
    const std::string own =
        folder.write("own.json", "[" + preset("a", 1) + ", " + preset("a", 2) + ", " + preset("a (2)", 3) + "]");
    CHECK(tfNamesIn(own) == std::vector<std::string>{"a", "a (3)", "a (2)"});
    CHECK(loadTf(own + "#a (2)").range == ValueRange{0, 3});
    CHECK(fileOfTf(file + "#c#d") == file);
    CHECK(fileOfTf(file) == file);
    CHECK_THROWS_WITH(loadTf(file + "#labels"), Contains("categories"));
    // One, in whatever format, is no choice.
    CHECK(tfNamesIn(folder.write("b.json", "[" + preset("a", 10) + "]")).empty());
    CHECK(tfNamesIn(folder.write("c.vp", writtenTf(slicerVpFormat(), {sample(), {}, {}, ""}).text)).empty());
    const std::string maps = folder.write("d.xml", R"(<ColorMaps><ColorMap name="x" space="RGB">
        <Point x="1" o="0" r="1" g="0" b="0"/><Point x="2" o="0.5" r="0" g="1" b="0"/></ColorMap>
        <ColorMap name="y" space="RGB"><Point x="3" o="0" r="1" g="0" b="0"/><Point x="5" o="0.5" r="0" g="1" b="0"/>
        </ColorMap></ColorMaps>)");
    CHECK(tfNamesIn(maps) == std::vector<std::string>{"x", "y"});
    CHECK(loadTf(maps + "#y").range == ValueRange{3, 5});
}

TEST_CASE("equal positions of 3D Slicer are a step", "[tf][formats]") {
    // As in its own presets for bones in micro CT.
    const ReadTf read = readOf("slicer-vp", "1\n1\n0.9\n0.1\n0.2\n10\n"
                                            "8 0 0 10 0 10 0.8 20 0.8\n4 0 1 255 1\n8 0 1 0 0 20 0 0 1\n");
    CHECK(read.tf.opacity(0.4999) == Approx(0).margin(1e-3));
    CHECK(read.tf.opacity(0.5) == 0.8);
    // Written again they lie apart, and the step is there.
    const ReadTf again = readOf("slicer-vp", writtenTf(slicerVpFormat(), {read.tf, {}, {}, ""}).text);
    CHECK(again.tf.opacity(0.49999) == Approx(0).margin(1e-3));
    CHECK(again.tf.opacity(0.50001) == Approx(0.8));
}

TEST_CASE("unknown keys of a volume property are kept, and strict JSON is written", "[tf][formats]") {
    const std::string text = R"({"@schema": "x", "volumeProperties": [{"effectiveRange": [0, 10], "myKey": 7,
        "scatteringAnisotropy": 0.3, "components": [{"scalarOpacityUnitDistance": 2.5, "mine": "too",
        "rgbTransferFunction": {"type": "colorTransferFunction",
            "points": [{"x": 0, "color": [1, 0, 0], "midpoint": 0.5, "sharpness": 0}, {"x": 10, "color": [0, 0, 1]}]},
        "scalarOpacity": {"type": "piecewiseLinearFunction", "points": [{"x": 0, "y": 0.2, "midpoint": 0.5, "sharpness": 0.5},
            {"x": 10, "y": 0.8}, {"x": 10, "y": 0.9}]}}]}]})";
    const ReadTf read = readOf("slicer", text);
    CHECK(read.length.value == 2.5);
    CHECK(read.tf.opacity(0.2) == Approx(0.200618).margin(kOpacityTolerance)); // sharpness as VTK has it
    const json again = json::parse(writtenTf(slicerFormat(), {read.tf, {}, {}, ""}).text);
    const json& property = again["volumeProperties"][0];
    CHECK(property["myKey"] == 7);
    CHECK(property["scatteringAnisotropy"] == 0.3);
    CHECK(property["components"][0]["mine"] == "too");
    CHECK(property["effectiveRange"] == json({0.0, 10.0}));
    CHECK_THAT(messageOf("slicer", R"({"volumeProperties": []})"), Contains("no volume property"));
    CHECK_THAT(messageOf("slicer", R"({"volumeProperties": [{}]})"), Contains("components"));
}

TEST_CASE("older colour maps of ParaView are read from XML", "[tf][formats]") {
    const std::string map = R"(<ColorMaps><ColorMap name="a" space="Wrapped" indexedLookup="false">
        <Point x="-5" o="0" r="1" g="0" b="0"/><Point x="15" o="0.5" r="0" g="1" b="0"/><NaN r="0" g="0" b="0"/>
        </ColorMap><ColorMap name="b" space="RGB" indexedLookup="true"><Point x="0" r="1" g="0" b="0"/></ColorMap></ColorMaps>)";
    const ReadTf read = readOf("paraview-xml", map);
    CHECK(read.tf.range == ValueRange{-5, 15});
    CHECK(read.tf.color(0.5).r == Approx(1).margin(0.02)); // yellow lies between red and green on the circle
    CHECK(read.tf.color(0.5).g == Approx(1).margin(0.02));
    CHECK(read.tf.opacity(0.5) == Approx(0.25));
    CHECK_THAT(messageOf("paraview-xml", map, "b"), Contains("categories"));
    CHECK_THAT(
        messageOf("paraview-xml", "<ColorMap space=\"Lab\"><Point x=\"1,5\" r=\"0\" g=\"0\" b=\"0\"/></ColorMap>"),
        Contains("'1,5' is not a number"));
}

TEST_CASE("files of Inviwo, niivue, ImageVis3D, MITK and ITK-SNAP are read as they write them", "[tf][formats]") {
    const ReadTf inviwo =
        readOf("inviwo", R"(<?xml version="1.0" ?><InviwoWorkspace version="2"><maskMin content="0.25" />
        <maskMax content="1" /><Points><Point><pos content="0" /><rgba x="1" y="0" z="0" w="0.2" /></Point>
        <Point><pos content="1" /><rgba x="0" y="0" z="1" w="0.6" /></Point></Points></InviwoWorkspace>)");
    CHECK(inviwo.tf.opacity(0.2) == 0); // outside the mask
    CHECK(inviwo.tf.opacity(0.25) == Approx(0.3));
    CHECK(inviwo.tf.opacity(0.75) == Approx(0.5));
    CHECK(inviwo.tf.opacity(1) == Approx(0.6));
    CHECK(inviwo.tf.color(0.5).r == Approx(0.5));
    // A mask over data values, 20 to 80 of 0 to 100; and one with nothing in it.
    const auto masked = [](const std::string& lo, const std::string& hi) {
        return readOf("inviwo", "<InviwoWorkspace version=\"3\"><maskMin content=\"" + lo + "\"/><maskMax content=\"" +
                                    hi +
                                    "\"/><type content=\"1\"/><Points>"
                                    "<Point><pos content=\"0\"/><rgba x=\"0\" y=\"0\" z=\"0\" w=\"0.5\"/></Point>"
                                    "<Point><pos content=\"100\"/><rgba x=\"1\" y=\"0\" z=\"0\" w=\"0.5\"/></Point>"
                                    "</Points></InviwoWorkspace>");
    };
    const ReadTf absolute = masked("20", "80");
    CHECK(absolute.tf.opacity(0.1) == 0);
    CHECK(absolute.tf.opacity(0.5) == Approx(0.5));
    CHECK(absolute.tf.opacity(0.9) == 0);
    for (const char* hi : {"20", "10"}) CHECK(masked("20", hi).tf.opacity(0.5) == 0);
    CHECK(masked("200", "300").tf.opacity(0.5) == 0);
    CHECK_THAT(
        messageOf("inviwo", R"(<InviwoWorkspace><Points><Point><pos content="1.5"/><rgba x="0" y="0" z="0" w="0"/>
        </Point></Points></InviwoWorkspace>)"),
        Contains("not between 0 and 1"));

    const ReadTf plain = readOf("niivue", R"({"R": [0, 255], "G": [0, 0], "B": [0, 0]})");
    CHECK(plain.tf.opacity(1) == Approx(64 / 255.0));
    CHECK(plain.tf.opacity(0.5) == Approx(32 / 255.0));
    const ReadTf placed = readOf(
        "niivue",
        R"({"min": 40, "max": 80, "R": [0, 255, 0], "G": [0, 0, 0], "B": [0, 0, 0], "A": [0, 128, 0], "I": [0, 51, 255]})");
    CHECK(placed.tf.range == ValueRange{40, 80});
    CHECK(placed.tf.opacity(0.2) == Approx(128 / 255.0)); // 51 of 255
    CHECK_THAT(messageOf("niivue", R"({"R": [0, 256], "G": [0, 0], "B": [0, 0]})"), Contains("between 0 and 255"));
    CHECK_THAT(messageOf("niivue", R"({"R": [0, 2], "G": [0], "B": [0, 0]})"), Contains("another number of values"));

    const ReadTf table = readOf("imagevis3d", "3\n0 0 0 0\n1 0 0 0.5\n0 0 1 0\n");
    CHECK(table.tf.opacity(0.25) == Approx(0.25));
    CHECK(table.tf.color(0.5).r == 1);
    CHECK_THAT(messageOf("imagevis3d", "3\n0 0 0 0\n1 0 0 0.5\n"), Contains("2 of 3 entries"));

    const std::string mitk = R"(<Version TransferfunctionVersion="1" /><TransferFunction><ScalarOpacity>
        <point x="-10" y="0" /><point x="10" y="0.4" /></ScalarOpacity><GradientOpacity><point x="0" y="1" />
        </GradientOpacity><Color><point x="-10" r="0" g="0" b="0" midpoint="0.5" sharpness="0" />
        <point x="10" r="1" g="1" b="1" midpoint="0.5" sharpness="0" /></Color></TransferFunction>)";
    CHECK(readOf("mitk", mitk).tf.range == ValueRange{-10, 10});
    CHECK(readOf("mitk", mitk).tf.opacity(0.5) == Approx(0.2));
    CHECK_THAT(messageOf("mitk", "<TransferFunction><ScalarOpacity/></TransferFunction>"),
               Contains("Color is missing"));

    const std::string snap =
        R"(<registry><entry key="NumberOfControlPoints" value="2" /><folder key="ControlPoint[0000]">
        <entry key="Index" value="0" /><entry key="Type" value="Continuous" /><folder key="Left"><entry key="R" value="255" />
        <entry key="G" value="0" /><entry key="B" value="0" /><entry key="A" value="51" /></folder></folder>
        <folder key="ControlPoint[0001]"><entry key="Index" value="1" /><entry key="Type" value="Continuous" />
        <folder key="Left"><entry key="R" value="0" /><entry key="G" value="0" /><entry key="B" value="255" />
        <entry key="A" value="153" /></folder></folder></registry>)";
    CHECK(readOf("itksnap", snap).tf.opacity(0.5) == Approx(0.4)); // 51 and 153 of 255
    CHECK_THAT(messageOf("itksnap", R"(<registry><entry key="Preset" value="jet"/></registry>)"),
               Contains("names a preset"));

    CHECK(readOf("csv", "value,red,green,blue,opacity\n10,1,0,0,0\n20,0,0,1,0.5\n").tf.range == ValueRange{10, 20});
    CHECK_THAT(messageOf("csv", "value,red,green,blue,opacity\n10;1;0;0;0\n"), Contains("1 of 5 numbers"));
    CHECK_THAT(messageOf("csv", "a,b\n1,2\n"), Contains("first line"));
}

TEST_CASE("a file of Voreen that is written keeps its steps as split keys", "[tf][formats]") {
    const std::string text = writtenTf(voreenFormat(), {sample(), {}, gridLike(Int3(200), Vec3(1)), ""}).text;
    CHECK_THAT(text, Contains("<domain x=\"-1000\" y=\"3000\" />") && Contains("<split value=\"true\" />"));
    const ReadTf read = readOf("voreen", text);
    CHECK(read.tf.opacity(0.24999) == Approx(0.3).margin(0.003)); // a cube of 200: 1/200 of it is a voxel
    CHECK(read.tf.opacity(0.25) == Approx(0.6).margin(0.003));
    CHECK(!read.opensAsItIs);
}

TEST_CASE("opacities of Voreen's own files are opened as those of a voxel, and converted for others", "[tf][formats]") {
    const std::string text = "<VoreenData><TransFuncIntensity><domain x=\"0\" y=\"9\"/><Keys>"
                             "<key><intensity value=\"0\"/><colorL r=\"255\" g=\"0\" b=\"0\" a=\"51\"/></key>"
                             "<key><intensity value=\"1\"/><colorL r=\"255\" g=\"0\" b=\"0\" a=\"51\"/></key>"
                             "</Keys></TransFuncIntensity></VoreenData>";
    const Geometry g = gridLike(Int3(100), Vec3(1));
    const ReadTf read = readOf("voreen", text);
    CHECK(read.opensAsItIs);
    CHECK(forVolume(read, g).opacity(0.5) == Approx(0.2));
    CHECK(says(openingNotices(read, g), "as the thesis has it"));
    CHECK(read.length.inWorld(g) == Approx(0.5)); // 100/200
}

TEST_CASE("a damaged file is read or refused in words", "[tf][formats]") {
    std::minstd_rand random(7);
    for (const TfFormat& format : tfFormats()) {
        const std::string whole = writtenTf(format, {sample(), {}, {}, "mine"}).text.substr(0, 6000);
        int refused = 0;
        for (int n = 0; n < 300; ++n) {
            std::string text = whole;
            for (int changes = 1 + n % 3; changes > 0; --changes)
                text[random() % text.size()] = "\0\"<>{}[],-e9 \xff"[random() % 15];
            if (n % 4 == 0) text.resize(random() % text.size());
            INFO(format.name << ":\n" << text);
            try {
                const ReadTf read = format.read(ForeignFile("a", text));
                REQUIRE_NOTHROW(read.tf.validate());
                REQUIRE_NOTHROW(writtenTf(format, {read.tf, {}, {}, "again"}));
            } catch (const Error& e) {
                ++refused;
                REQUIRE(!e.problem().empty());
            }
        }
        INFO(format.name);
        CHECK(refused > 0);
    }
}

TEST_CASE("formats are told by suffix and by content", "[tf][formats]") {
    const test::TempFolder folder;
    const TransferFunction tf = sample();
    for (const TfFormat& format : tfFormats()) {
        INFO(format.name);
        const std::string text = writtenTf(format, {tf, {}, {}, "mine"}).text;
        const std::string own = folder.write(std::string("own") + format.suffix, text);
        CHECK(openTfFile(own).tf.points.size() >= 2);
        CHECK(isForeignTf(own) == (std::string(format.name) != "pellucid"));
        CHECK(isTfFile(own));
        // Under a name that says nothing: presets of vtk.js are those of ParaView.
        const std::string unnamed = folder.write(std::string("unnamed-") + format.name, text);
        const std::string known = tfFormatOf(ForeignFile(unnamed, text)).name;
        CHECK(known == (std::string(format.name) == "vtkjs" ? "paraview" : format.name));
    }
    CHECK(isTfFile(folder.write("b.json", writtenTf(paraViewFormat(), {tf, {}, {}, "b"}).text)));
    CHECK_FALSE(isTfFile(folder.write("c.json", "{\"a\": 1}")));
    CHECK_FALSE(isTfFile(folder.write("d.xml", "<VTKFile/>")));
    CHECK_FALSE(isTfFile(folder.path("none.json")));
    CHECK_THROWS_AS(openTfFile(folder.write("e.bin", "what is this?")), FileError);
    CHECK_THROWS_AS(tfFormatNamed("word"), UsageError);
    // One of several in a file, by a name behind a #.
    const std::string several = folder.write(
        "f.json",
        R"([{"Name": "a", "RGBPoints": [0, 0, 0, 0, 9, 1, 1, 1]}, {"Name": "b c", "RGBPoints": [5, 0, 0, 0, 7, 1, 1, 1]}])");
    CHECK(loadTf(several + "#b c").range == ValueRange{5, 7});
    const std::string one = folder.write("g.tf.json", writtenTf(pellucidTfFormat(), {tf, {}, {}, "g"}).text);
    CHECK_THROWS_WITH(openTfFile(one + "#g"), Contains("it holds one transfer function"));
}

TEST_CASE("what is wrong with a file that is hardly one is said of the file", "[tf][formats]") {
    const test::TempFolder folder;
    CHECK_THROWS_WITH(openTfFile(folder.write("a.csv", "")), Contains("the file is empty") && Contains("a.csv"));
    CHECK_THROWS_WITH(openTfFile(folder.write("b.xml", " \n")), Contains("the file is empty"));
    CHECK(messageOf("csv", "value,red,green,blue,opacity\n0,0,0,0,\"0\n1,1,1,1,1\n")
              .find("a text in quotes does not end") != std::string::npos);
    const std::string tooWide =
        messageOf("niivue", R"({"min": -1e308, "max": 1e308, "R": [0, 1], "G": [0, 1], "B": [0, 1]})");
    CHECK(tooWide.find("too far apart") != std::string::npos);
    CHECK(tooWide.find("/max") != std::string::npos);
}

TEST_CASE("a preset is called as its file, without folder and suffix", "[tf][formats]") {
    CHECK(presetNameOf("out/bone.vp.json") == "bone");
    CHECK(presetNameOf("out/bone.tf.json") == "bone");
    CHECK(presetNameOf("bone.json") == "bone");
    CHECK(presetNameOf("bone") == "bone");
}

TEST_CASE("numbers are written the same in a locale with decimal commas", "[tf][formats]") {
    const std::string before = std::setlocale(LC_ALL, nullptr);
    const bool hasCommas = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
    if (!hasCommas) WARN("SKIPPED: there is no locale de_DE.UTF-8");
    const TransferFunction tf = sample();
    std::vector<std::string> texts;
    for (const TfFormat& format : tfFormats()) texts.push_back(writtenTf(format, {tf, {}, {}, "a"}).text);
    std::size_t i = 0;
    for (const TfFormat& format : tfFormats()) CHECK_NOTHROW(format.read(ForeignFile("a", texts[i++])));
    std::setlocale(LC_ALL, before.c_str());
    i = 0;
    for (const TfFormat& format : tfFormats()) CHECK(texts[i++] == writtenTf(format, {tf, {}, {}, "a"}).text);
}

TEST_CASE("colours, opacities and range are taken one by one", "[tf][formats][parts]") {
    TransferFunction now, other;
    now.points = {{0, 0.2, {1, 0, 0}, false, {}}, {1, 0.6, {1, 0, 0}, false, {}}};
    now.range = ValueRange{0, 10};
    now.features = deriveFeatures(now);
    other.points = {{0, 0.9, {0, 0, 0}, false, {}}, {1, 0.1, {0, 0, 1}, false, {}}};
    other.range = ValueRange{0, 20};
    other.features = deriveFeatures(other);

    const TransferFunction colors = withParts(now, other, {true, false, false});
    CHECK(colors.range == now.range);
    CHECK(colors.opacity(0.5) == Approx(0.4));
    CHECK(colors.color(1).b == Approx(0.5)); // the value 10 of 20
    const TransferFunction opacities = withParts(now, other, {false, true, false});
    CHECK(opacities.color(0.5) == Rgb{1, 0, 0});
    CHECK(opacities.opacity(1) == Approx(0.5)); // half way from 0.9 to 0.1
    const TransferFunction range = withParts(now, other, {false, false, true});
    CHECK(range.range == ValueRange{0, 20});
    CHECK(range.opacity(0.25) == Approx(0.4)); // the value 5 keeps it
    CHECK(withParts(now, other, {true, true, true}) == other);
}

TEST_CASE("snippets have every point, and lists that Python takes", "[tf][formats][snippets]") {
    const TfToWrite writing(sample(), {}, gridLike(Int3(10), {0.5, 1, 1}), "");
    CHECK(tfSnippets().size() == 4);
    for (const TfSnippet& snippet : tfSnippets()) {
        const std::string text = snippet.text(writing);
        INFO(snippet.name);
        CHECK_THAT(text, Contains("(-1000, 1, 0.5, 0, 0),") && Contains("(3000, 1, 1, 1, 0),") &&
                             Contains("unit_distance = 0.5"));
    }
}

TEST_CASE("lines of Python tell the losses that files tell", "[tf][formats][snippets]") {
    TransferFunction tf = tents(3);
    tf.points.front().opacity = 5e-5; // which VTK takes for 0
    for (const TfSnippet& snippet : tfSnippets()) {
        INFO(snippet.name);
        const std::vector<std::string> losses = writtenTf(snippet, {tf, {}, {}, ""}).losses;
        CHECK(says(losses, "3 features are not stored"));
        CHECK(says(losses, "no data range is known"));
        CHECK(says(losses, "no volume is known"));
        CHECK(says(losses, "of at most 0.0001") == (std::string(snippet.name) != "napari"));
        const std::vector<std::string> placed =
            writtenTf(snippet, {tf, ValueRange{0, 9}, gridLike(Int3(10), Vec3(1)), ""}).losses;
        CHECK_FALSE(says(placed, "is known"));
    }
}

TEST_CASE("formats are told in sentences", "[tf][formats]") {
    const test::TempFolder folder;
    CHECK_THROWS_WITH(openTfFile(folder.write("e.bin", "what is this?")),
                      Contains("a preset of vtk.js, a table (CSV), a transfer function of ImageVis3D"));
}
