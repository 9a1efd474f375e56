// Whatever is wrong: the right exit status, one line on stderr in three parts, nothing on stdout, no file left behind.
#include <algorithm>
#include <thread>

#include <catch2/catch.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "cli_runner.h"

using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace {

/// Runs it and checks everything that all errors have in common.
void checkFails(const Workshop& w, const Words& arguments, int status, const std::string& part) {
    std::string line;
    for (const std::string& a : arguments) line += a + " ";
    INFO(line);
    const auto before = w.list();
    const Outcome o = w.run(arguments);
    INFO(o.err);
    CHECK(o.status == status);
    CHECK(o.out.empty());
    CHECK(o.err.rfind("pellucid-cli: error: ", 0) == 0);
    CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
    CHECK(o.err.ends_with("\n"));
    // WHAT, WHERE, WHAT TO DO
    std::size_t commas = 0;
    for (std::size_t at = o.err.find(", "); at != std::string::npos; at = o.err.find(", ", at + 1)) ++commas;
    CHECK(commas >= 2);
    CHECK(o.err.find(part) != std::string::npos);
    CHECK(w.list() == before);
}

const Words kShells{"sample:shells", "--size", "16"};
const Words kMeasure = Words{"measure"} + kShells;
const Words kRefine = Words{"refine"} + kShells;
const Words kOptimize = Words{"optimize"} + kShells;
const Words kDraw{"render", "sample:shells", "--sample-size", "16"};
const Words kRender = kDraw + Words{"--out", "x.png"};

/// A NRRD header of a raw-encoded u8 volume with these lines in it, followed by `bytes` zeros.
std::string nrrd(const std::string& lines, std::size_t bytes) {
    return "NRRD0004\ntype: uchar\ndimension: 3\n" + lines + "encoding: raw\nendian: little\n\n" +
           std::string(bytes, '\0');
}

} // namespace

TEST_CASE("wrong words are wrong usage", "[cli][errors]") {
    const Workshop w;
    checkFails(w, {}, 2, "no command");
    checkFails(w, {"paint"}, 2, "unknown command 'paint'");
    checkFails(w, {"--paint"}, 2, "unknown option '--paint'");
    checkFails(w, {"info"}, 2, "VOLUME is required");
    checkFails(w, {"info", ""}, 2, "VOLUME");
    checkFails(w, kMeasure + Words{"--paint"}, 2, "unknown option '--paint'");
    checkFails(w, kMeasure + Words{"more"}, 2, "unexpected argument 'more'");
    checkFails(w, kMeasure + Words{"--sigma"}, 2, "--sigma has no value");
    checkFails(w, kMeasure + Words{"--sigma", "1", "--sigma", "2"}, 2, "--sigma is given more than once");
    // Options of other commands, and of later ones.
    checkFails(w, kRefine + Words{"--engine", "cpu"}, 2, "unknown option '--engine'");
    checkFails(w, kRefine + Words{"--target", "1,2,3"}, 2, "unknown option '--target'");
    checkFails(w, kMeasure + Words{"--variable", "y=f"}, 1, "f, ");
    checkFails(w, {"samples", "--size", "3"}, 2, "unknown option '--size'");
}

TEST_CASE("wrong values of the volume's options are wrong usage", "[cli][errors]") {
    const Workshop w;
    w.write("v.raw", std::string(8, '\1'));
    checkFails(w, {"info", "sample:cube"}, 2, "disks, shells, knee");
    checkFails(w, {"info", "sample:shells", "--size", "0"}, 2, "--size");
    checkFails(w, {"info", "sample:shells", "--size", "1e3"}, 2, "--size");
    checkFails(w, {"info", "v.raw", "--raw", "2,2,u8"}, 2, "--raw");
    checkFails(w, {"info", "v.raw", "--raw", "2,2,0,u8"}, 2, "--raw");
    checkFails(w, {"info", "v.raw", "--raw", "2,2,-2,u8"}, 2, "--raw");
    checkFails(w, {"info", "v.raw", "--raw", "2,2,2,u7"}, 2, "--raw");
    checkFails(w, {"info", "v.raw", "--raw", "2,2,2,u8,middle"}, 2, "--raw");
    checkFails(w, {"info", "v.raw", "--spacing", "1,1,1"}, 1, "give --raw");
    checkFails(w, {"info", "v.raw", "--skip", "4"}, 2, "give --raw");
    checkFails(w, {"info", "v.raw", "--raw", "2,2,2,u8", "--spacing", "1,-1,1"}, 2, "--spacing");
    checkFails(w, {"info", "v.raw", "--raw", "2,2,2,u8", "--spacing", "1,1"}, 2, "--spacing");
    checkFails(w, {"info", "v.raw", "--raw", "2,2,2,u8", "--spacing", "1,nan,1"}, 2, "--spacing");
    checkFails(w, {"info", "v.raw", "--raw", "2,2,2,u8", "--spacing", "1,1,1,ells"}, 2, "not a unit of length");
    checkFails(w, {"info", "v.raw", "--raw", "2,2,2,u8", "--skip", "-1"}, 2, "--skip");
    checkFails(w, {"info", "v.raw", "--raw", "2,2,2,u8", "--size", "16"}, 2, "sample");
    checkFails(w, {"info", "v.raw", "--raw", "2,2,2,u8", "--component", "-1"}, 2, "--component");
    for (const char* range : {"5,1", "3,3", "nan,1", "0,inf", "-1e308,1e308", "5", ""})
        checkFails(w, Words{"info"} + kShells + Words{"--range", range}, 2, "--range");
    checkFails(w, Words{"info"} + kShells + Words{"--missing", "none"}, 2, "--missing");
    checkFails(w, Words{"info"} + kShells + Words{"--seed", "-1"}, 2, "--seed");
    for (const char* threads : {"0", "-2", "1.5"})
        checkFails(w, kMeasure + Words{"--threads", threads}, 2, "--threads");
}

TEST_CASE("wrong values of views, engines and measures are wrong usage", "[cli][errors]") {
    const Workshop w;
    for (const char* view : {"0", "0,0,0", "0,91", "nan,0", "1,2,3,4"})
        checkFails(w, kMeasure + Words{"--view", view}, 2, "--view");
    checkFails(w, kMeasure + Words{"--engine", "cuda"}, 2, "cuda");
    checkFails(w, kMeasure + Words{"--quality", "best"}, 2, "--quality");
    for (const char* sigma : {"-1", "0", "nan", "1e9"}) checkFails(w, kMeasure + Words{"--sigma", sigma}, 2, "--sigma");
    checkFails(w, kMeasure + Words{"--kernel", "wide"}, 2, "--kernel");
    checkFails(w, kMeasure + Words{"--w1", "-1"}, 2, "--w1");
    checkFails(w, kMeasure + Words{"--u1", "0.5", "--u2", "0.6"}, 2, "sum to 1");
    checkFails(w, kMeasure + Words{"--saliency-background", "0,0,2"}, 2, "--saliency-background");
    checkFails(w, kMeasure + Words{"--tf", "tents:0"}, 2, "tents");
    checkFails(w, kMeasure + Words{"--tf", "tents:3:1.5"}, 2, "tents");
    checkFails(w, kMeasure + Words{"--tf", "ramp:x"}, 2, "ramp");
}

TEST_CASE("wrong values of render are wrong usage", "[cli][errors]") {
    const Workshop w;
    checkFails(w, {"render", "sample:shells"}, 2, "--out is required");
    for (const char* size : {"0x0", "64", "-5x5", "16385x10", "axb"})
        checkFails(w, kRender + Words{"--size", size}, 2, "--size");
    for (const char* background : {"0,0,1.5", "#12345", "red", "#fff/red"})
        checkFails(w, kRender + Words{"--background", background}, 2, "--background");
    for (const char* step : {"0", "17", "nan"}) checkFails(w, kRender + Words{"--step", step}, 2, "--step");
    for (const char* step : {"0.001", "17"}) checkFails(w, kRender + Words{"--finest-step", step}, 2, "--finest-step");
    for (const char* clip : {"x:0.5:0.5", "w:0:1", "x:0", "x:-1:1", "x:a:b"})
        checkFails(w, kRender + Words{"--clip", clip}, 2, "--clip");
    checkFails(w, kRender + Words{"--clip", "x:0:0.2", "x:0.5:1"}, 2, "--clip");
    checkFails(w, kRender + Words{"--mode", "xray"}, 2, "minip");
    checkFails(w, kRender + Words{"--light-preset", "gold"}, 2, "metal");
    checkFails(w, kRender + Words{"--no-shading", "--shading"}, 2, "--no-shading");
    checkFails(w, kRender + Words{"--depth-cue", "2"}, 2, "--depth-cue");
    checkFails(w, kRender + Words{"--tf", "tents:3", "--feature", "dentine"}, 2, "'f3'");
    // Before any work: the volume would be refused too.
    checkFails(w, {"render", "missing.nrrd", "--out", "x.bmp"}, 2, "x.bmp");
    checkFails(w, {"render", "missing.nrrd", "--out", ""}, 2, "--out");
    checkFails(w, {"render", "missing.nrrd", "--out", "x.jpg", "--background", "transparent"}, 2, "JPEG");
}

TEST_CASE("wrong values of refine and optimize are wrong usage", "[cli][errors]") {
    const Workshop w;
    for (const char* step : {"0", "2", "nan"}) checkFails(w, kRefine + Words{"--step-down", step}, 2, "--step-down");
    checkFails(w, kRefine + Words{"--step-up", "automatic"}, 2, "--step-up");
    checkFails(w, kRefine + Words{"--max-iterations", "-1"}, 2, "--max-iterations");
    checkFails(w, kRefine + Words{"--fix", "1.5"}, 2, "--fix");
    checkFails(w, kRefine + Words{"--method", "best"}, 2, "give greedy or exact");
    for (const char* x : {"-0.1", "1.1", "300", "nan"})
        checkFails(w, kRefine + Words{"--intensity", x}, 2, "--intensity");
    checkFails(w, kRefine + Words{"--hue", "red"}, 2, "--hue");
    checkFails(w, kRefine + Words{"--intensity", "0.5", "--hue", "30"}, 2, "more than one priority");
    const Words samples{"refine", "sample:shells", "--sample-size", "16"};
    for (const char* region : {"1,2,3", "1,2,1,4", "5,6,1,2", "-1,0,4,4", "0.5,0,4,4", "0,0,4,4,5"})
        checkFails(w, samples + Words{"--region", region}, 2, "--region");
    checkFails(w, samples + Words{"--region", "0,0,40,4", "--size", "32x32"}, 2, "outside the picture of 32 x 32");
    checkFails(w, samples + Words{"--region", "0:4,0:4"}, 2, "--region"); // voxels: three intervals
    // The picture is looked at for a region alone.
    const std::vector<Words> ofPictures{
        {"--view", "0,0"}, {"--orthographic"}, {"--clip", "x:0:0.5"}, {"--size", "32x32"}};
    for (const Words& words : ofPictures) checkFails(w, samples + words, 2, words[0]);
    // Its corner shows nothing.
    checkFails(w, samples + Words{"--region", "0,0,2,2", "--size", "32x32"}, 1, "the region shows nothing");
    checkFails(w, kRefine + Words{"--tf", "tents:3", "--fix", "0.4"}, 2, "0.366667"); // lists the points there are
    checkFails(w, kOptimize, 2, "--target is required");
    for (const char* target : {"1,1", "1,1,1,1", "0,0,0", "-1,1,1", "1,nan,1", "1,,1"})
        checkFails(w, kOptimize + Words{"--target", target}, 2, "--target");
    const Words targeted = kOptimize + Words{"--target", "1,1,1"};
    checkFails(w, targeted + Words{"--method", "newton2"}, 2, "newton2");
    checkFails(w, targeted + Words{"--direction", "upward"}, 2, "--direction");
    checkFails(w, targeted + Words{"--b", "0"}, 2, "--b");
    checkFails(w, targeted + Words{"--lock", "nobody"}, 2, "--lock");
    checkFails(w, targeted + Words{"--limits", "nobody:0:1"}, 2, "--limits");
    for (const char* limits : {"bone", "bone:0.1", "bone:0.5:0.1", "bone:-1:1", "bone:0:2", ":0:1"})
        checkFails(w, targeted + Words{"--limits", limits}, 2, "--limits");
    checkFails(w, targeted + Words{"--step", "0"}, 2, "--step");
    checkFails(w, targeted + Words{"--tolerance", "-0.1"}, 2, "--tolerance");
    checkFails(w, targeted + Words{"--max-iterations", "many"}, 2, "--max-iterations");
}

TEST_CASE("what memory will not do for fails before it starts", "[cli][errors]") {
    const Workshop w;
    // 200³ voxels: the volume takes 16 MB, measuring 96 MB more, optimizing 64 MB.
    const Words volume{"sample:disks", "--size", "200", "--tf", "tents:3", "--memory", "0.07"};
    const std::string what = "200 x 200 x 200 voxels needs ";
    checkFails(w, Words{"measure"} + volume, 1, "reading and measuring " + what + "80 MB of memory");
    checkFails(w, Words{"measure", "--engine", "reference"} + volume, 1, what + "120 MB of memory");
    checkFails(w, Words{"fields", "--out", "d"} + volume, 1, what + "112 MB of memory");
    checkFails(w, Words{"optimize", "--target", "1,1,1"} + volume, 1, "reading and optimizing " + what + "80 MB");
    checkFails(w, {"render", "sample:disks", "--sample-size", "400", "--out", "a.png", "--memory", "0.1"}, 1,
               "reading and drawing 400 x 400 x 400 voxels needs 320 MB");
    checkFails(w, {"info", "sample:disks", "--size", "400", "--memory", "0.1"}, 1, "allow more with --memory");
    for (const char* bad : {"0", "-1", "much", "inf", ""})
        checkFails(w, {"measure", "sample:disks", "--memory", bad}, 2, "--memory");
    CHECK(w.run({"info", "sample:disks", "--memory", "0.5"}).status == 0);
}

TEST_CASE("wrong values of bench are wrong usage", "[cli][errors]") {
    const Workshop w;
    const Words bench = Words{"bench"} + kShells;
    for (const char* rows : {"paint", "", "sweep,", "sweep;render", "Sweep"})
        checkFails(w, bench + Words{"--only", rows}, 2, "give open, setup, saliency, saliency-direct, sweep");
    for (const char* repeat : {"0", "-1", "many", "1001"})
        checkFails(w, bench + Words{"--repeat", repeat}, 2, "--repeat");
    checkFails(w, bench + Words{"--threads", "0"}, 2, "--threads");
    checkFails(w, bench + Words{"--full"}, 2, "--full");
    checkFails(w, bench + Words{"--tf", "tents:0"}, 2, "tents");
    checkFails(w, {"bench", "--size", "24"}, 2, "no volume");
    checkFails(w, {"bench", "missing.nrrd"}, 1, "missing.nrrd");
}

TEST_CASE("bad volume files fail with their name", "[cli][errors]") {
    const Workshop w;
    REQUIRE(w.run({"generate", "shells", "--size", "16", "--out", "good.nrrd"}).status == 0);
    const std::string good = w.read("good.nrrd");
    w.write("truncated.nrrd", good.substr(0, good.size() / 2));
    w.write("empty.nrrd", "");
    w.write("text.nrrd", "this is a letter\n");
    w.write("image.nrrd", std::string("\x89PNG\r\n\x1a\n") + std::string(64, '\0'));
    w.write("absurd.nrrd", nrrd("sizes: 10000 10000 10000\n", 8));
    w.write("overflow.nrrd", nrrd("sizes: 4294967296 4294967296 4294967296\n", 8));
    w.write("spacing.nrrd", nrrd("sizes: 2 2 2\nspacings: 1 -1 1\n", 8));
    w.write("short.nrrd", nrrd("sizes: 2 2 2\n", 7));
    w.write("absurd.mhd", "ObjectType = Image\nNDims = 3\nDimSize = 10000 10000 10000\nElementType = MET_UCHAR\n"
                          "ElementDataFile = good.nrrd\n");
    w.write("orphan.mhd",
            "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = no.raw\n");
    w.write("volume.xyz", std::string(8, '\1'));
    w.write("v.raw", std::string(8, '\1'));
    w.write("new\nline.nrrd", "x"); // the message is one line all the same
    std::filesystem::create_directory(w.path("folder"));

    for (const char* file : {"truncated.nrrd", "empty.nrrd", "text.nrrd", "image.nrrd", "absurd.nrrd", "overflow.nrrd",
                             "spacing.nrrd", "short.nrrd", "volume.xyz", "v.raw", "folder", "missing.nrrd"})
        checkFails(w, {"info", file}, 1, file);
    // These name the file with the data.
    checkFails(w, {"info", "absurd.mhd"}, 1, "good.nrrd");
    checkFails(w, {"info", "orphan.mhd"}, 1, "no.raw");
    checkFails(w, {"info", "new\nline.nrrd"}, 1, "new line.nrrd");
    checkFails(w, {"info", "v.raw"}, 1, "give --raw NX,NY,NZ,TYPE");
    checkFails(w, {"info", "v.raw", "--raw", "2,2,3,u8"}, 1, "v.raw");
    checkFails(w, {"info", "v.raw", "--raw", "2,2,1,u8"}, 1, "v.raw");
    checkFails(w, {"info", "v.raw", "--raw", "10000,10000,10000,f64"}, 1, "v.raw");
    checkFails(w, {"info", "v.raw", "--raw", "2,2,2,u8", "--skip", "9"}, 1, "v.raw");
    // The same one line from every command that opens a volume.
    for (const Words& command :
         {Words{"measure", "absurd.nrrd"}, Words{"refine", "absurd.nrrd"},
          Words{"optimize", "absurd.nrrd", "--target", "1,1,1"}, Words{"render", "absurd.nrrd", "--out", "x.png"},
          Words{"fields", "absurd.nrrd", "--out", "f"}})
        checkFails(w, command, 1, "absurd.nrrd");
}

TEST_CASE("bad transfer functions and cameras fail with the place", "[cli][errors]") {
    const Workshop w;
    const auto badTf = [&](const std::string& text, const std::string& part) {
        w.write("bad.tf.json", text);
        checkFails(w, kMeasure + Words{"--tf", "bad.tf.json"}, 1, part);
    };
    const std::string head = R"({"format":"pellucid-tf","version":1,)";
    badTf("", "bad.tf.json");
    badTf("{", "bad.tf.json");
    badTf("[]", "bad.tf.json");
    badTf(R"({"format":"other","version":1,"points":[]})", "bad.tf.json at /format");
    badTf(R"({"format":"pellucid-tf","version":99,"points":[]})", "99");
    badTf(head + R"("pts":[]})", "points");
    badTf(head + R"("points":[{"x":1.5,"opacity":0,"color":"#ffffff"}]})", "/points/0");
    badTf(head + R"("points":[{"x":0.5,"opacity":0,"color":"#ffffff"},{"x":0.4,"opacity":0,"color":"#ffffff"}]})",
          "/points/1");
    badTf(head + R"("points":[{"x":0.5,"color":"#ffffff"}]})", "opacity");
    badTf(head + R"("points":[{"x":0.5,"opacity":0,"color":"white"}]})", "/points/0/color");
    badTf(head + R"("range":[5,5],"points":[]})", "/range");
    checkFails(w, kMeasure + Words{"--tf", "missing.tf.json"}, 1, "missing.tf.json");
    checkFails(w, kMeasure + Words{"--tf", ""}, 2, "--tf");

    const auto badCamera = [&](const std::string& text) {
        w.write("bad.camera.json", text);
        checkFails(w, kMeasure + Words{"--camera", "bad.camera.json"}, 1, "bad.camera.json");
    };
    badCamera("eye");
    badCamera("{}");
    badCamera(R"({"projection":"fisheye","eye":[0,-99,0],"center":[0,0,0],"up":[0,0,1],"fov_y":30})");
    badCamera(R"({"projection":"perspective","eye":[0,-99],"center":[0,0,0],"up":[0,0,1],"fov_y":30})");
    badCamera(R"({"projection":"perspective","eye":[0,-99,0],"center":[0,0,0],"up":[0,1,0],"fov_y":30})");
    badCamera(R"({"projection":"perspective","eye":[0,-99,0],"center":[0,-99,0],"up":[0,0,1],"fov_y":30})");
    badCamera(R"({"projection":"perspective","eye":[0,-99,0],"center":[0,0,0],"up":[0,0,1],"fov_y":200})");
    badCamera(R"({"projection":"orthographic","eye":[0,-99,0],"center":[0,0,0],"up":[0,0,1],"height":0})");
    // Inside the box, which reaches from −0.5 to 15.5.
    badCamera(R"({"projection":"perspective","eye":[7,7,7],"center":[0,0,0],"up":[0,0,1],"fov_y":30})");
    checkFails(w, kMeasure + Words{"--camera", "missing.json"}, 1, "missing.json");
    checkFails(w, kMeasure + Words{"--camera", "bad.camera.json", "--view", "0,0"}, 2, "--view");
    checkFails(w, kMeasure + Words{"--camera", "bad.camera.json", "--orthographic"}, 2, "--orthographic");
}

TEST_CASE("what cannot be written fails before the work", "[cli][errors]") {
    const Workshop w;
    std::filesystem::create_directory(w.path("folder.png"));
    w.write("file", "x");
    // "missing.nrrd" would fail too: the complaint about the output comes first.
    checkFails(w, {"render", "missing.nrrd", "--out", "no/x.png"}, 1, "no");
    checkFails(w, {"render", "missing.nrrd", "--out", "folder.png"}, 1, "folder.png");
    checkFails(w, {"render", "missing.nrrd", "--out", "file/x.png"}, 1, "this is a file, not a folder, file");
    checkFails(w, {"refine", "missing.nrrd", "--out-tf", "no/x.tf.json"}, 1, "no");
    checkFails(w, {"optimize", "missing.nrrd", "--target", "1,1,1", "--out-tf", "no/x.tf.json"}, 1, "no");
    checkFails(w, {"fields", "missing.nrrd", "--out", "no/deep"}, 1, "no");
    checkFails(w, {"fields", "missing.nrrd", "--out", "file"}, 1, "file");
    checkFails(w, {"fields", "missing.nrrd", "--out", ""}, 2, "--out");
    const std::string longName(252, 'n');
    checkFails(w, {"render", "missing.nrrd", "--out", longName + ".png"}, 1, "name too long");
    checkFails(w, {"fields", "missing.nrrd", "--out", longName + longName}, 1, "name too long");
    checkFails(w, {"refine", "missing.nrrd", "--out-tf", "new/"}, 1, "this names a folder, new/");
    std::filesystem::create_directories(w.path("d/vws.nrrd"));
    checkFails(w, {"fields", "missing.nrrd", "--out", "d"}, 1, "a folder has this name, d/vws.nrrd");
    std::filesystem::create_symlink("loop", w.path("loop"));
    checkFails(w, {"refine", "missing.nrrd", "--out-tf", "loop"}, 1, "symbolic links), loop");
    std::filesystem::create_symlink("no/where", w.path("dangling"));
    checkFails(w, {"refine", "missing.nrrd", "--out-tf", "dangling"}, 1, "the folder does not exist, no");
    checkFails(w, {"fields", "missing.nrrd", "--out", "dangling"}, 1, "dangling");
    checkFails(w, {"generate", "shells", "--out", "no/x.nrrd"}, 1, "no");
    checkFails(w, {"generate", "shells", "--out", "x.mhd"}, 2, "x.mhd");
    checkFails(w, {"generate", "cube", "--out", "x.nrrd"}, 2, "shells");
    checkFails(w, {"generate", "shells"}, 2, "--out is required");
}

TEST_CASE("a full disk is told, and leaves what was there", "[cli][errors]") {
    const Workshop w;
    const std::size_t room = 400; // bytes per file: enough for the message
    const std::vector<Words> commands{
        kDraw + Words{"--out", "a.png"},
        kDraw + Words{"--out", "a.jpg"},
        kDraw + Words{"--out", "a.tif"},
        kDraw + Words{"--out", "a.exr"},
        {"generate", "shells", "--size", "16", "--out", "a.nrrd"},
        Words{"fields", "--engine", "cpu", "--out", "."} + kShells,
        Words{"fields", "--engine", "cpu", "--out", "new"} + kShells,
        kRefine + Words{"--tf", "tents:9", "--out-tf", "a.tf.json"},
        kOptimize + Words{"--engine", "cpu", "--target", "1,1,1", "--max-iterations", "1", "--out-tf", "a.tf.json"}};
    for (const char* old : {"a.png", "a.jpg", "a.tif", "a.exr", "a.nrrd", "visibility.nrrd", "a.tf.json"})
        w.write(old, "older");
    const auto before = w.list();
    for (const Words& command : commands) {
        const Outcome o = w.runWithFilesUpTo(room, command);
        INFO(command.front() << ": " << o.err);
        CHECK(o.status == 1);
        CHECK(o.out.empty());
        CHECK(o.err.rfind("pellucid-cli: error: cannot write the file (File too large), ", 0) == 0);
        CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
    }
    CHECK(w.list() == before);
    for (const std::string& old : before) CHECK(w.read(old) == "older");
    // A device takes its bytes directly.
    checkFails(w, kRefine + Words{"--out-tf", "/dev/full"}, 1, "No space left on device");
}

TEST_CASE("a name may be any bytes, and lead to a device", "[cli]") {
    const Workshop w;
    for (const std::string name : {"\xff\xfe.png", "-x.png", "a\nb.png", "%s.png", "a:b.png"}) {
        CHECK(w.run(kDraw + Words{"--engine", "cpu", "--out", name}).status == 0);
        CHECK(w.has(name));
    }
    CHECK(w.run(kRefine + Words{"--out-tf", std::string(255, 'n')}).status == 0);
    std::filesystem::create_symlink("/dev/null", w.path("null.png"));
    std::filesystem::create_symlink("/dev/null", w.path("null.nrrd"));
    CHECK(w.run(kDraw + Words{"--engine", "cpu", "--out", "null.png"}).status == 0);
    CHECK(w.json({"generate", "shells", "--size", "16", "--out", "null.nrrd"})["file_bytes"].is_null());
    CHECK(std::filesystem::is_symlink(w.path("null.nrrd")));
    CHECK(w.run(kRefine + Words{"--out-tf", "/dev/stdout"}).out.find("pellucid-tf") != std::string::npos);
}

TEST_CASE("what is write-protected stays", "[cli][errors]") {
    const Workshop w;
    w.write("a.tf.json", "older");
    std::filesystem::create_directory(w.path("d"));
    using std::filesystem::perms;
    std::filesystem::permissions(w.path("a.tf.json"), perms::owner_read);
    std::filesystem::permissions(w.path("d"), perms::owner_read | perms::owner_exec);
    if (access(w.path("d").c_str(), W_OK) == 0) {
        WARN("SKIPPED: this user may write everywhere");
        return;
    }
    checkFails(w, {"refine", "missing.nrrd", "--out-tf", "a.tf.json"}, 1, "the file is write-protected, a.tf.json");
    checkFails(w, {"refine", "missing.nrrd", "--out-tf", "d/x"}, 1, "the folder is not writable, d");
    checkFails(w, {"fields", "missing.nrrd", "--out", "d"}, 1, "the folder is not writable, d");
    checkFails(w, {"fields", "missing.nrrd", "--out", "d/new"}, 1, "the folder is not writable, d");
    CHECK(w.read("a.tf.json") == "older");
}

TEST_CASE("no command overwrites what it reads", "[cli][errors]") {
    namespace fs = std::filesystem;
    const Workshop w;
    REQUIRE(w.run({"generate", "shells", "--size", "16", "--out", "visibility.nrrd"}).status == 0);
    REQUIRE(w.run(kRefine + Words{"--out-tf", "a.tf.json"}).status == 0);
    w.write("data.png", std::string(8, '\1'));
    w.write("a.mhd", "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
                     "ElementDataFile = data.png\n");
    w.write("a.nhdr", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: ./data.png\n\n");
    w.write("camera.json", R"({"projection":"perspective","eye":[0,-99,0],"center":[0,0,0],"up":[0,0,1],"fov_y":30})");
    fs::create_directory(w.path("d"));
    fs::create_symlink("../a.tf.json", w.path("d/link.json"));
    fs::create_hard_link(w.path("a.tf.json"), w.path("hard.json"));
    fs::create_directory(w.path("e"));
    fs::create_symlink("../visibility.nrrd", w.path("e/vws.nrrd"));

    const auto refused = [&](const Words& command, const std::string& where) {
        checkFails(w, command, 2, "error: the output would overwrite the input, " + where + ", choose another name\n");
    };
    const Words refine = kRefine + Words{"--tf", "a.tf.json", "--out-tf"};
    refused(refine + Words{"a.tf.json"}, "a.tf.json");
    for (const char* same : {"./a.tf.json", "d/../a.tf.json", "d/link.json", "hard.json"})
        refused(refine + Words{same}, std::string(same) + ", which is a.tf.json");
    refused({"refine", "visibility.nrrd", "--out-tf", "visibility.nrrd"}, "visibility.nrrd");
    const Words optimize = kOptimize + Words{"--target", "1,1,1"};
    refused(optimize + Words{"--tf", "d/link.json", "--out-tf", "a.tf.json"}, "a.tf.json, which is d/link.json");
    refused(optimize + Words{"--camera", "camera.json", "--out-tf", "camera.json"}, "camera.json");
    refused({"render", "data.png", "--raw", "2,2,2,u8", "--out", "data.png"}, "data.png");
    refused({"render", "a.mhd", "--out", "./data.png"}, "./data.png, which is data.png");
    refused({"render", "a.nhdr", "--out", "data.png"}, "data.png, which is ./data.png");
    refused({"fields", "visibility.nrrd", "--out", "."}, "./visibility.nrrd, which is visibility.nrrd");
    refused({"fields", "visibility.nrrd", "--out", "e"}, "e/vws.nrrd, which is visibility.nrrd");
    refused({"fields", "sample:shells", "--tf", "e/vws.nrrd", "--out", "."}, "./visibility.nrrd, which is e/vws.nrrd");

    // Another file of the same content, or a device, is no input.
    w.write("other.json", w.read("a.tf.json"));
    CHECK(w.run(refine + Words{"other.json"}).status == 0);
    checkFails(w, kRefine + Words{"--tf", "/dev/null", "--out-tf", "/dev/null"}, 1, "/dev/null");
}

TEST_CASE("endless and enormous JSON ends in an error", "[cli][errors]") {
    const Workshop w;
    for (const std::string option : {"--tf", "--camera"}) {
        checkFails(w, kMeasure + Words{option, "/dev/zero"}, 1, "it has more than 16.8 MB, /dev/zero, ");
        checkFails(w, kMeasure + Words{option, "/dev/null"}, 1,
                   std::string(option) == "--tf" ? "the file is empty" : "not valid JSON");
        checkFails(w, kMeasure + Words{option, "."}, 1, "this is a folder");
        w.write("digits.json", "{\"format\":" + std::string(10'000'000, '9') + "}");
        checkFails(w, kMeasure + Words{option, "digits.json"}, 1, "a number that is too large");
        w.write("fraction.json", "{\"format\":0." + std::string(10'000'000, '0') + "1}");
        checkFails(w, kMeasure + Words{option, "fraction.json"}, 1, "fraction.json");
        w.write("deep.json", std::string(10'000'000, '['));
        checkFails(w, kMeasure + Words{option, "deep.json"}, 1, "nested more than 64 deep");
        w.write("wide.json", "[0" + std::string(4'000'000, ' ') + std::string(1, ']'));
        checkFails(w, kMeasure + Words{option, "wide.json"}, 1, "a JSON object is expected");
    }
    // A pipe is read to its end.
    REQUIRE(w.run(kRefine + Words{"--out-tf", "a.tf.json"}).status == 0);
    REQUIRE(mkfifo(w.path("pipe").c_str(), 0600) == 0);
    std::thread writer([&] { w.write("pipe", w.read("a.tf.json")); });
    const Outcome o = w.run(kMeasure + Words{"--tf", "pipe", "--engine", "cpu"});
    writer.join();
    INFO(o.err);
    CHECK(o.status == 0);
}

TEST_CASE("a failed command leaves an existing file as it was", "[cli][errors]") {
    const Workshop w;
    w.write("x.png", "an older picture");
    w.write("x.tf.json", "an older transfer function");
    checkFails(w, kRender + Words{"--feature", "dentine"}, 2, "dentine");
    checkFails(w, kRefine + Words{"--fix", "0.4", "--out-tf", "x.tf.json"}, 2, "--fix");
    CHECK(w.read("x.png") == "an older picture");
    CHECK(w.read("x.tf.json") == "an older transfer function");
}
