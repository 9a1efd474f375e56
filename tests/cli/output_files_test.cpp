// No output replaces an input or another output, whatever option names them.
#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>

#include <catch2/catch.hpp>

#include "cli_runner.h"

using pellucid::test::operator+;
using pellucid::test::Outcome;
using pellucid::test::Words;
using pellucid::test::Workshop;

namespace fs = std::filesystem;

namespace {

const std::string kOverwrites = "error: the output would overwrite the input, ";
const std::string kSame = "error: two outputs would be the same file, ";

/// Everything that lies in a folder and below, by name, with what it holds.
std::map<std::string, std::string> contentsOf(const Workshop& w) {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(w.path("")))
        if (entry.is_regular_file()) {
            const std::string name = fs::relative(entry.path(), w.path("")).string();
            all[name] = w.read(name);
        }
    return all;
}

/// Nothing is answered, and every file is as it was.
void checkRefused(const Workshop& w, const Words& command, const std::string& message) {
    const auto before = contentsOf(w);
    const Outcome outcome = w.run(command);
    std::string line;
    for (const std::string& word : command) line += " " + word;
    INFO(line);
    INFO(outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.find(message) != std::string::npos);
    CHECK(contentsOf(w) == before);
}

const Words kShellsToRender{"sample:shells", "--sample-size", "16", "--tf", "tents:3"};
const Words kTarget{"--target", "1,1,1"};

} // namespace

TEST_CASE("no output replaces the file of a variable, of the ground or of a camera", "[cli][output-files]") {
    const Workshop w;
    REQUIRE(w.run({"generate", "shells", "--size", "16", "--out", "y.nrrd"}).status == 0);
    w.write("data.raw", std::string(4096, '\1'));
    w.write("detached.mhd", "ObjectType = Image\nNDims = 3\nDimSize = 16 16 16\nElementType = MET_UCHAR\n"
                            "ElementDataFile = data.raw\n");
    w.write("detached.nhdr", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 16 16 16\nencoding: raw\n"
                             "data file: data.raw\n\n");
    w.write("ground.raw", std::string(16, '\1'));
    const Words optimize = Words{"optimize"} + kShellsToRender + kTarget;

    checkRefused(w, optimize + Words{"--variable", "y=y.nrrd", "--out-tf", "y.nrrd"}, kOverwrites + "y.nrrd, ");
    checkRefused(w, optimize + Words{"--variable", "y=y.nrrd", "--out-camera", "./y.nrrd"},
                 kOverwrites + "./y.nrrd, which is y.nrrd, ");
    // What a header names is read, too.
    for (const char* header : {"detached.mhd", "detached.nhdr"}) {
        checkRefused(w, optimize + Words{"--variable", std::string("y=") + header, "--out-tf", "data.raw"},
                     kOverwrites + "data.raw");
        checkRefused(w,
                     Words{"space"} + kShellsToRender + kTarget +
                         Words{"--variable", std::string("y=") + header, "--save", "data.raw"},
                     kOverwrites + "data.raw");
        checkRefused(w, Words{"refine", header, "--out-tf", header}, kOverwrites + header);
    }
    checkRefused(w, Words{"space", "y.nrrd", "--tf", "tents:3", "--save", "y.nrrd"} + kTarget, kOverwrites + "y.nrrd");
    w.write("ground.png", std::string(16, '\1'));
    checkRefused(w,
                 Words{"render"} + kShellsToRender +
                     Words{"--ground", "ground.png", "--ground-raw", "4,4,u8", "--out", "ground.png"},
                 kOverwrites + "ground.png");
    fs::create_directory(w.path("fields"));
    fs::rename(w.path("y.nrrd"), w.path("fields/vws.nrrd"));
    checkRefused(w, Words{"fields"} + kShellsToRender + Words{"--variable", "y=fields/vws.nrrd", "--out", "fields"},
                 kOverwrites + "fields/vws.nrrd");
    fs::rename(w.path("fields/vws.nrrd"), w.path("fields/vws_f2.nrrd")); // known only when features are
    checkRefused(w,
                 Words{"fields"} + kShellsToRender +
                     Words{"--variable", "y=fields/vws_f2.nrrd", "--feature", "f2", "--out", "fields"},
                 kOverwrites + "fields/vws_f2.nrrd");
}

TEST_CASE("no output replaces a member of a series or what a session names", "[cli][output-files]") {
    const Workshop w;
    fs::create_directory(w.path("o"));
    for (const std::string n : {"0", "1", "2"}) w.write("f" + n + ".raw", std::string(512, static_cast<char>(n[0])));
    const Words series{"sequence", "f%d.raw", "--raw", "8,8,8,u8", "--no-pictures"};
    REQUIRE(w.run(series + Words{"--tf", "tents:3", "--out", "o"}).status == 0);
    // The transfer function that it begins with is that of a frame of the same folder.
    checkRefused(w, series + Words{"--tf", "o/frame_0001.tf.json", "--out", "o"}, kOverwrites + "o/frame_0001.tf.json");
    // The frame at hand is f0; f2 is read later.
    checkRefused(w, {"refine", "f%d.raw", "--raw", "8,8,8,u8", "--tf", "tents:3", "--out-tf", "f2.raw"},
                 kOverwrites + "f2.raw");
    checkRefused(w,
                 {"refine", "sample:shells", "--sample-size", "16", "--tf", "o/frame_0002.tf.json", "--out-tf",
                  "o/../o/frame_0002.tf.json"},
                 kOverwrites + "o/../o/frame_0002.tf.json, which is o/frame_0002.tf.json");

    w.write("s.pellucid.json", R"({"format":"pellucid-session","version":1,"variables":[
        {"name":"x","transfer_functions":[],"source":{"sample":"shells","size":16,"seed":1}},
        {"name":"y","transfer_functions":[],"source":{"path":"f1.raw","raw":
            {"dims":[8,8,8],"type":"u8","endian":"little","spacing":[1,1,1],"skip":0}}}]})");
    const Words session{"optimize", "--session", "s.pellucid.json"};
    checkRefused(w, session + kTarget + Words{"--out-tf", "f1.raw"}, "f1.raw");
    checkRefused(w, session + kTarget + Words{"--out-tf", "s.pellucid.json"}, kOverwrites + "s.pellucid.json");
}

TEST_CASE("two outputs are two files", "[cli][output-files]") {
    const Workshop w;
    fs::create_directory(w.path("r"));
    fs::create_symlink("a.json", w.path("link.json")); // leads nowhere yet
    const Words optimize = Words{"optimize"} + kShellsToRender + kTarget;
    checkRefused(w, optimize + Words{"--out-tf", "a.json", "--out-camera", "a.json"},
                 kSame + "--out-tf a.json and --out-camera a.json, choose another name for one\n");
    checkRefused(w, optimize + Words{"--out-tf", "a.json", "--out-camera", "r/../a.json"}, kSame);
    checkRefused(w, optimize + Words{"--out-tf", "link.json", "--out-camera", "a.json"},
                 kSame + "--out-tf link.json and --out-camera a.json, ");
    checkRefused(w, optimize + Words{"--report", "r", "--curves", "r/curves.csv"},
                 kSame + "--curves r/curves.csv and --report r/curves.csv, ");
    const Words space = Words{"space"} + kShellsToRender + kTarget;
    checkRefused(w, space + Words{"--csv", "s.nrrd", "--save", "s.nrrd"}, kSame);
    checkRefused(w,
                 Words{"views"} + kShellsToRender + Words{"--feature", "f1", "--out-camera", "v.csv", "--map", "v.csv"},
                 kSame);
    w.write("old.json", "older");
    fs::create_hard_link(w.path("old.json"), w.path("hard.json"));
    checkRefused(w, optimize + Words{"--out-tf", "old.json", "--out-camera", "hard.json"}, kSame);

    // A device takes what comes, and what is written once may be replaced the next time.
    const Words twice = optimize + Words{"--out-tf", "/dev/null", "--out-camera", "/dev/null", "--curves", "c.csv"};
    CHECK(w.run(twice).status == 0);
    CHECK(w.run(twice).status == 0);
}

TEST_CASE("a film leaves the files beside it alone", "[cli][output-files]") {
    const Workshop w;
    for (const std::string n : {"0", "1"}) w.write("f" + n + ".raw", std::string(512, static_cast<char>(n[0])));
    fs::create_directory(w.path("bin"));
    w.write("bin/ffmpeg",
            "#!/bin/sh\nwhile [ $# -gt 1 ]; do shift; done\nprintf '\\000\\000\\000\\014freefilm' > \"$1\"\n");
    fs::permissions(w.path("bin/ffmpeg"), fs::perms::owner_all);
    for (const char* mine : {"film.mp4.list", "film.mp4.log", "film.mp4.part.mp4"}) w.write(mine, "mine");
    const std::string before = std::getenv("PATH");
    setenv("PATH", (w.path("bin").string() + ":/usr/bin:/bin").c_str(), 1);
    const Outcome outcome = w.run({"sequence", "f%d.raw", "--raw", "8,8,8,u8", "--tf", "tents:3", "--size", "16x16",
                                   "--out", "o", "--mp4", "film.mp4"});
    setenv("PATH", before.c_str(), 1);
    INFO(outcome.err);
    CHECK(outcome.status == 0);
    CHECK(w.read("film.mp4").substr(4) == "freefilm"); // a box of MP4, 12 bytes (14 in octal) with its head
    for (const char* mine : {"film.mp4.list", "film.mp4.log", "film.mp4.part.mp4"}) CHECK(w.read(mine) == "mine");
    CHECK(w.list() == std::vector<std::string>{"bin", "f0.raw", "f1.raw", "film.mp4", "film.mp4.list", "film.mp4.log",
                                               "film.mp4.part.mp4", "o"});
}

// Found by --help, so that an option of tomorrow is looked at, too: each that names a file and is none of those that
// are read is given the name of the volume.
TEST_CASE("every option that names an output refuses the volume", "[cli][output-files]") {
    const std::set<std::string> read{"--tf", "--camera", "--session", "--ground", "--overlay"};
    const std::map<std::string, Words> needed{{"optimize", kTarget}, {"sequence", {"--out", "frames"}},
                                              {"space", kTarget},    {"views", {"--feature", "f1"}},
                                              {"render", {}},        {"refine", {}},
                                              {"propose", {}}};
    const std::regex file("(?:^|\n)  (--[a-z-]+) FILE\\b");
    int found = 0;
    for (const auto& [command, words] : needed) {
        const Workshop w;
        const std::string help = w.run({command, "--help"}).out;
        for (std::sregex_iterator i(help.begin(), help.end(), file), end; i != end; ++i) {
            const std::string option = (*i)[1];
            if (read.contains(option)) continue;
            ++found;
            int refused = 0;
            for (const std::string suffix : {".png", ".csv", ".json", ".nrrd", ".mp4", ".exr"}) {
                const std::string name = "volume" + suffix;
                w.write(name, std::string(512, '\1'));
                Words line{command, name, "--raw", "8,8,8,u8"};
                if (command != "propose") line = line + Words{"--tf", "tents:3"};
                const Outcome outcome = w.run(line + words + Words{option, name});
                INFO(command << " " << option << " " << name << ": " << outcome.err);
                CHECK(outcome.status != 0);
                CHECK(w.read(name) == std::string(512, '\1'));
                refused += outcome.err.find(kOverwrites + name) != std::string::npos ? 1 : 0;
            }
            INFO(command << " " << option);
            CHECK(refused > 0); // where the suffix suits
        }
    }
    CHECK(found == 12); // render 2, refine 1, propose 1, optimize 3, space 3, views 2; sequence has a folder
}
