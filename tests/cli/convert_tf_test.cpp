// convert TF --to NAME, and --tf with files of other programs.
#include <catch2/catch.hpp>

#include <cmath>

#include "cli_runner.h"

using nlohmann::json;
using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

const Words kVolume{"sample:disks", "--sample-size", "16"};
const Words kForVolume{"--volume", "sample:disks", "--sample-size", "16"};

bool says(const json& list, const std::string& words) {
    for (const json& one : list)
        if (one.get<std::string>().find(words) != std::string::npos) return true;
    return false;
}

} // namespace

TEST_CASE("a transfer function is converted for another program", "[cli][convert]") {
    const Workshop w;
    const json told =
        w.jsonAndNotes(Words{"convert", "tents:3:0.4", "--to", "paraview", "--out", "a.paraview.json"} + kForVolume);
    CHECK(told["command"] == "convert");
    CHECK(told["to"] == "paraview");
    const json info = w.jsonAndNotes(Words{"info"} + kVolume);
    CHECK(told["range"] == info["range"]);
    CHECK(says(told["losses"], "3 features"));
    CHECK_FALSE(says(told["losses"], "no volume"));
    REQUIRE(w.has("a.paraview.json"));

    // Opened with the volume it has the opacities that it had; only its features are made anew.
    const Words measure{"measure"};
    const json before = w.jsonAndNotes(measure + kVolume + Words{"--tf", "tents:3:0.4"});
    const json after = w.jsonAndNotes(measure + kVolume + Words{"--tf", "a.paraview.json"});
    REQUIRE(after["features"].size() == 3);
    for (std::size_t f = 0; f < 3; ++f) {
        CHECK(after["features"][f]["opacity"].get<double>() == Approx(0.4).margin(1e-6));
        CHECK(after["features"][f]["vws"].get<double>() ==
              Approx(before["features"][f]["vws"].get<double>()).margin(3e-3));
    }
    const Outcome said = w.run(measure + kVolume + Words{"--tf", "a.paraview.json"});
    CHECK_THAT(said.err, Catch::Contains("opacities are converted from paths of"));

    // And on from there: sqrt(3) voxels to one.
    w.jsonAndNotes(Words{"convert", "a.paraview.json", "--to", "pellucid", "--out", "b.tf.json"} + kForVolume);
    CHECK(w.jsonAndNotes(measure + kVolume + Words{"--tf", "b.tf.json"})["features"][1]["opacity"].get<double>() ==
          Approx(0.4).margin(1e-6));
}

TEST_CASE("every format is written and opened again", "[cli][convert]") {
    const Workshop w;
    for (const char* name : {"pellucid", "paraview", "slicer", "slicer-vp", "slicer-xml", "voreen", "paraview-xml",
                             "inviwo", "niivue", "vtkjs", "csv", "imagevis3d", "mitk", "itksnap"}) {
        INFO(name);
        const std::string file = std::string(name) + ".any";
        const json told = w.jsonAndNotes(Words{"convert", "tents:2:0.5", "--to", name, "--out", file} + kForVolume);
        CHECK(told["losses"].empty() == (std::string(name) == "pellucid"));
        const json opened = w.jsonAndNotes(Words{"measure"} + kVolume + Words{"--tf", file});
        CHECK(opened["features"].size() >= 1);
    }
}

TEST_CASE("a transfer function is written as Python for other programs' consoles", "[cli][convert]") {
    const Workshop w;
    for (const char* name : {"paraview-python", "slicer-python", "pyvista-python", "napari-python"}) {
        INFO(name);
        const json told = w.jsonAndNotes(Words{"convert", "tents:2:0.5", "--to", name, "--out", "a.py"} + kForVolume);
        CHECK(told["to"] == name);
        CHECK_THAT(w.read("a.py"), Catch::Contains("unit_distance = 1") && Catch::Contains("points = ["));
        CHECK(says(told["losses"], "2 features"));
        CHECK_FALSE(says(told["losses"], "is known"));
        const json alone = w.jsonAndNotes({"convert", "tents:3", "--to", name, "--out", "b.py"});
        CHECK(says(alone["losses"], "no data range is known"));
        CHECK(says(alone["losses"], "no volume is known"));
    }
}

TEST_CASE("a program that lays a curve over the data gets it for all values of the data", "[cli][convert]") {
    const Workshop w;
    // A window of half the data, and one measure of it by the file that was written.
    w.jsonAndNotes(Words{"convert", "tents:2:0.5", "--to", "pellucid", "--out", "a.tf.json", "--range", "20,150"} +
                   kForVolume);
    const Words measure = Words{"measure"} + kVolume + Words{"--range", "20,150"};
    const json before = w.jsonAndNotes(measure + Words{"--tf", "a.tf.json"});
    REQUIRE(before["features"].size() == 2);
    for (const char* name : {"itksnap", "imagevis3d"}) {
        INFO(name);
        const json told = w.jsonAndNotes(Words{"convert", "a.tf.json", "--to", name, "--out", name} + kForVolume);
        CHECK(says(told["losses"], "all values of the data, "));
        CHECK_FALSE(says(told["losses"], "assumed"));
        const json after = w.jsonAndNotes(measure + Words{"--tf", name});
        REQUIRE(after["features"].size() == 2);
        for (std::size_t f = 0; f < 2; ++f)
            CHECK(after["features"][f]["visibility"].get<double>() ==
                  Approx(before["features"][f]["visibility"].get<double>()).margin(0.01));
    }
    CHECK(says(w.jsonAndNotes({"convert", "a.tf.json", "--to", "itksnap", "--out", "b"})["losses"],
               "assumed to be 20 to 150; name a volume"));
    // What a file without a range is put on is told: positions of the file, and values.
    w.write("c.json", R"([{"Name": "c", "RGBPoints": [-1, 0, 0, 0, 1, 1, 1, 1]}])");
    CHECK_THAT(w.run(measure + Words{"--tf", "c.json"}).err,
               Catch::Contains("its positions -1 to 1 are put on the values 20 to 150"));
}

TEST_CASE("what a conversion assumes is said, and wrong ones are refused", "[cli][convert]") {
    const Workshop w;
    const json told = w.jsonAndNotes({"convert", "tents:2", "--to", "voreen", "--out", "a.tfi"});
    CHECK(says(told["losses"], "no data range is known"));
    CHECK(says(told["losses"], "no volume is known"));
    CHECK_FALSE(told.contains("range"));
    const auto refused = [&](const Words& words, int status, const std::string& message) {
        const Outcome outcome = w.run(words);
        CHECK(outcome.status == status);
        CHECK_THAT(outcome.err, Catch::Contains(message));
    };
    refused({"convert", "tents:2", "--to", "word", "--out", "b"}, 2, "paraview, slicer");
    refused({"convert", "tents:2", "--to", "word", "--out", "b"}, 2, "paraview-python");
    refused({"convert", "none.tfi", "--to", "slicer", "--out", "b"}, 1, "no such file");
    refused({"convert", "auto", "--to", "slicer", "--out", "b"}, 2, "--volume");
    refused(Words{"convert"} + kVolume + Words{"--volume", "a.nrrd", "--out", "b.nrrd"}, 2, "add --to");
    refused({"convert", "tents:2", "--to", "slicer", "--type", "u8", "--out", "b"}, 2, "no samples");
    refused({"convert", "a.tfi", "--to", "slicer", "--out", "a.tfi"}, 2, "a.tfi"); // over what it reads
    CHECK_FALSE(w.has("b"));
    refused(Words{"convert"} + kVolume + Words{"--all-frames", "--frame", "0", "--out", "b.nrrd"}, 2,
            "one frame and all frames");
    CHECK_THAT(w.run({"convert", "tents:2", "--to", "slicer", "--out", "d.json"}).err,
               Catch::Contains("end in .vp.json"));
    const Outcome table = w.run({"convert", "tents:2", "--to", "csv", "--out", "d.txt"});
    CHECK(table.out == "wrote d.txt: a table (CSV)\n");
    CHECK_THAT(table.err, Catch::Contains("the name of a table (CSV) should end in .tf.csv"));
    CHECK_THAT(w.run({"convert", "tents:2", "--to", "slicer", "--out", "d.vp.json"}).err,
               !Catch::Contains("end in .vp.json"));
    w.write("c.json", R"([{"Name": "c", "IndexedColors": [1, 0, 0], "Annotations": [0, "bone"]}])");
    refused({"convert", "c.json", "--to", "slicer", "--out", "b"}, 1, "categories");
}

TEST_CASE("parts of a transfer function are taken, the rest stays", "[cli][convert]") {
    const Workshop w;
    w.jsonAndNotes(Words{"convert", "tents:2:0.5", "--to", "pellucid", "--out", "two.tf.json"} + kForVolume);
    const Words measure = Words{"measure"} + kVolume;
    // Of two tents over the start that the data propose: the features are those whose opacities are taken.
    const json opacities = w.jsonAndNotes(measure + Words{"--tf", "two.tf.json", "--tf-parts", "opacities"});
    REQUIRE(opacities["features"].size() == 2);
    for (const json& feature : opacities["features"])
        CHECK(feature["opacity"].get<double>() == Approx(0.5).margin(1e-9));
    const json start = w.jsonAndNotes(measure);
    const json colors = w.jsonAndNotes(measure + Words{"--tf", "two.tf.json", "--tf-parts", "colors"});
    REQUIRE(colors["features"].size() == start["features"].size());
    for (std::size_t f = 0; f < start["features"].size(); ++f) {
        CHECK(colors["features"][f]["name"] == start["features"][f]["name"]);
        CHECK(colors["features"][f]["visibility"].get<double>() ==
              Approx(start["features"][f]["visibility"].get<double>()).margin(1e-6));
    }
    const auto refused = [&](const Words& words, const std::string& message) {
        const Outcome outcome = w.run(measure + words);
        CHECK(outcome.status == 2);
        CHECK_THAT(outcome.err, Catch::Contains(message));
    };
    refused({"--tf-parts", "colors"}, "there is no file to take parts of");
    refused({"--tf", "two.tf.json", "--tf-parts", "shape"}, "no part of a transfer function");
}

TEST_CASE("opacities of another program's file are converted for an overlay, too", "[cli][convert][overlay]") {
    const Workshop w;
    const Words draw{"render", "sample:shells", "--sample-size", "16",  "--tf",      "tents:3:0.02",
                     "--size", "40x40",         "--engine",      "cpu", "--overlay", "sample:disks"};
    // The same curve as ours and as ParaView's, whose opacities hold for another length, make the same picture.
    w.jsonAndNotes(Words{"convert", "tents:3:0.3", "--to", "pellucid", "--out", "a.tf.json"} + kForVolume);
    w.jsonAndNotes({"convert", "a.tf.json", "--to", "paraview", "--out", "a.paraview.json", "--volume", "sample:shells",
                    "--sample-size", "16"});
    w.jsonAndNotes(draw + Words{"--overlay-tf", "a.tf.json", "--out", "ours.png"});
    w.jsonAndNotes(draw + Words{"--overlay-tf", "a.paraview.json", "--out", "theirs.png"});
    const json difference = w.json({"compare", "ours.png", "theirs.png"});
    CHECK(difference["ssim"].get<double>() > 0.999);
    const Outcome said = w.run(draw + Words{"--overlay-tf", "a.paraview.json", "--out", "again.png"});
    CHECK_THAT(said.err, Catch::Contains("opacities are converted from paths of"));
}

TEST_CASE("answers are written for other programs, too", "[cli][convert]") {
    const Workshop w;
    const Outcome outcome = w.run(Words{"refine"} + kVolume + Words{"--tf", "ramp:4", "--out-tf", "a.vp"});
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.err, Catch::Contains("not stored"));
    CHECK(w.jsonAndNotes(Words{"measure"} + kVolume + Words{"--tf", "a.vp"})["features"].size() >= 1);
}

TEST_CASE("programs that lay a curve over the data get it for all frames of a series", "[cli][tf]") {
    const Workshop w;
    const auto volume = [](int first) { // 4³ voxels, from first to first + 63
        std::string bytes = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n\n";
        for (int i = 0; i < 64; ++i) bytes += static_cast<char>(first + i);
        return bytes;
    };
    w.write("d_1.nrrd", volume(10));
    w.write("d_2.nrrd", volume(60));
    w.jsonAndNotes({"convert", "tents:2", "--to", "pellucid", "--volume", "d_1.nrrd", "--out", "a.tf.json"});
    const json told =
        w.jsonAndNotes({"convert", "a.tf.json", "--to", "itksnap", "--volume", "d_%d.nrrd", "--out", "a.itksnap.xml"});
    CHECK(says(told["losses"], "all values of the data, 10 to 123")); // 60 + 63
    CHECK_FALSE(says(told["losses"], "frame 0"));
    // It is opened where it was written for: the middle of 10 to 123, not that of the first frame.
    const json again =
        w.jsonAndNotes({"convert", "a.itksnap.xml", "--to", "pellucid", "--volume", "d_%d.nrrd", "--out", "b.tf.json"});
    CHECK(again["range"] == json({10, 123}));
    // So is what a command that works on one frame writes.
    const Outcome refined =
        w.run({"refine", "d_%d.nrrd", "--frame", "1", "--tf", "tents:2", "--out-tf", "r.itksnap.xml"});
    CHECK(refined.status == 0);
    CHECK_THAT(refined.err, Catch::Contains("all values of the data, 10 to 123"));
}
