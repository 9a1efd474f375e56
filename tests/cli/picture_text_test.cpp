// What pictures say of themselves, the way back to their session, and their layers.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include <catch2/catch.hpp>

#include "cli_runner.h"
#include "command_line.h"
#include "image_io/image_file.h"
#include "image_io/png_text.h"
#include "support/caption_numbers.h"

using namespace pellucid;
using namespace pellucid::test;
using nlohmann::json;

namespace {

const Words kKnee{"render", "sample:knee", "--sample-size", "24", "--size", "40x30", "--engine", "cpu"};

std::map<std::string, std::string> textsOf(const Workshop& w, const std::string& file) {
    std::map<std::string, std::string> texts;
    for (const PngText& text : readPngTexts(w.path(file).string())) texts[text.keyword] = text.text;
    return texts;
}

/// The words of a command line without quotes.
Words wordsOf(const std::string& line) {
    Words words;
    std::istringstream in(line);
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

} // namespace

TEST_CASE("a PNG picture says what it shows, and how to draw it again", "[cli][picture-text]") {
    const Workshop w;
    const Words look{"--tf", "tents:3", "--view", "30,20,1.2", "--shading", "--background", "transparent"};
    w.json(kKnee + look + Words{"--threads", "1", "--out", "a.png"});
    const auto texts = textsOf(w, "a.png");
    REQUIRE(texts.size() == 4);
    CHECK(texts.at("Software").starts_with("Pellucid "));
    CHECK(texts.at("Description").find("lit: knee") != std::string::npos);
    CHECK(texts.at("Description").find('%') == std::string::npos); // nothing has been measured

    const Words command = wordsOf(texts.at("pellucid:command"));
    CHECK(command.front() == "pellucid-cli");
    CHECK(command.back() == "picture.png");
    CHECK(std::ranges::find(command, "--threads") == command.end());
    w.json(Words(command.begin() + 1, command.end()));
    CHECK(readImage(w.path("picture.png").string()).rgba == readImage(w.path("a.png").string()).rgba);

    // Neither its name nor what no pixel hangs on changes a byte.
    w.json(kKnee + look + Words{"--threads", "2", "--out=b.png"});
    CHECK(w.read("a.png") == w.read("b.png"));
    w.json(kKnee + look + Words{"--no-metadata", "--out", "c.png"});
    CHECK(textsOf(w, "c.png").empty());
    CHECK(readImage(w.path("c.png").string()).rgba == readImage(w.path("a.png").string()).rgba);
}

TEST_CASE("the caption of a picture has figures where they are asked for, those of describe", "[cli][picture-text]") {
    const Workshop w;
    const Words view{"--tf", "tents:2", "--view", "0,0"};
    w.json(kKnee + view + Words{"--caption", "--out", "a.png"});
    const json said = w.json(Words{"describe", "sample:knee", "--sample-size", "24", "--engine", "cpu"} + view);
    CHECK(textsOf(w, "a.png").at("Description") == said["caption"]);
    CHECK(said["caption"].get<std::string>().find('%') != std::string::npos);
    CHECK(w.run(kKnee + Words{"--caption", "--slice", "z:0.5", "--out", "b.png"}).status == 2);
    CHECK(w.run(kKnee + Words{"--caption", "--no-metadata", "--out", "b.png"}).status == 2);
    w.json(kKnee + Words{"--slice", "z:0.5", "--out", "b.png"});
    CHECK(textsOf(w, "b.png").at("Description").find("slice ") != std::string::npos);
}

TEST_CASE("describe takes the look of a picture as render does", "[cli][picture-text]") {
    const Workshop w;
    const Words scene{"--tf", "tents:2", "--view", "0,0"};
    const auto describe = [&](const Words& look) {
        const Words all = Words{"describe", "sample:knee", "--sample-size", "24", "--engine", "cpu"} + scene + look;
        return w.json(all)["caption"].get<std::string>();
    };
    const std::string plain = describe({});
    CHECK(plain.find(", lit") == std::string::npos);
    const std::pair<Words, std::string> looks[] = {
        {{"--shading"}, ", lit: knee. "},
        {{"--light-preset", "matte", "--background", "1,1,1"}, ", lit: knee. "},
        {{"--mode", "mip"}, ", the largest value along each ray: knee."}}; // and no shares, which it does not show
    for (const auto& [look, words] : looks) {
        INFO(look.front());
        const std::string said = describe(look);
        CHECK(said.find(words) != std::string::npos);
        w.json(kKnee + scene + look + Words{"--caption", "--out", "a.png"});
        CHECK(textsOf(w, "a.png").at("Description") == said);
    }
    CHECK(describe({"--mode", "mip"}).find('%') == std::string::npos);
    // Light changes no share: what comes after the first sentence is the same.
    const std::string lit = describe({"--shading"});
    CHECK(lit.substr(lit.find("knee. ")) == plain.substr(plain.find("knee. ")));
}

TEST_CASE("the numbers that describe says are those that measure tells", "[cli][picture-text]") {
    const Workshop w;
    const Words looks[] = {{"--tf", "tents:2", "--view", "30,20"},
                           {"--tf", "tents:3:0.1", "--view", "-80,40,1.4", "--orthographic"},
                           {"--tf", "tents:4:0.9", "--view", "200,-35", "--shading"},
                           {"--tf", "ramp:5", "--view", "10,80", "--clip", "x:0:0.6"}};
    for (const char* sample : {"sample:shells", "sample:smoke", "sample:disks"})
        for (const Words& look : looks) {
            const Words scene = Words{sample, "--sample-size", "16", "--engine", "cpu"} + look;
            const json described = w.json(Words{"describe"} + scene);
            Words plain = scene;
            std::erase(plain, "--shading"); // which changes no figure, and measure takes it with a picture alone
            const json measured = w.json(Words{"measure", "--occlusion"} + plain);
            const std::string text = described["caption"];
            const SaidNumbers said = numbersIn(text);
            CAPTURE(sample, text);
            REQUIRE(said.numbers == std::ranges::count(text, '%'));
            std::map<std::string, std::size_t> indices;
            for (std::size_t f = 0; f < measured["features"].size(); ++f) {
                const json& feature = measured["features"][f];
                indices[feature["name"]] = f;
                if (said.shares.count(feature["name"]) == 0) {
                    CHECK((feature["empty"] == true || feature["visibility"] == 0.0));
                    continue;
                }
                checkSaid(said.shares.at(feature["name"]).vws, feature["vws"]);
                checkSaid(said.shares.at(feature["name"]).visibility, feature["visibility"]);
            }
            if (said.coverage) checkSaid(*said.coverage, measured["coverage"]);
            for (const SaidNumbers::Hiding& h : said.hides)
                checkSaid(h.part, measured["occlusion"][indices.at(h.hidden)][indices.at(h.hider)]);
        }
}

TEST_CASE("a picture is a session, wherever it and its data are moved together", "[cli][picture-text]") {
    const Workshop w;
    std::filesystem::create_directory(w.path("one"));
    w.json({"generate", "knee", "--size", "24", "--out", "one/scan.nrrd"});
    const std::string volume = std::filesystem::absolute(w.path("one/scan.nrrd")).string();
    w.json({"render", volume, "--size", "40x30", "--engine", "cpu", "--tf", "tents:3", "--view", "40,-10,1.3",
            "--shading", "--clip", "x:0:0.6", "--out", "one/a.png"});
    const auto texts = textsOf(w, "one/a.png");
    // No path from the root: neither the folder of the test nor anything above it.
    CHECK(texts.at("pellucid:command").find(volume) == std::string::npos);
    CHECK(texts.at("pellucid:command").find(" one/scan.nrrd ") != std::string::npos);
    CHECK(texts.at("pellucid:session").find(w.path("one").string()) == std::string::npos);
    CHECK(json::parse(texts.at("pellucid:session"))["format"] == "pellucid-session");

    std::filesystem::rename(w.path("one"), w.path("two"));
    w.json({"render", "--session", "two/a.png", "--size", "40x30", "--out", "b.png"});
    CHECK(readImage(w.path("b.png").string()).rgba == readImage(w.path("two/a.png").string()).rgba);
    CHECK(w.json({"info", "--session", "two/a.png"})["dims"][0] == 24);

    // A picture cannot be its own session, and others carry none.
    CHECK(w.run({"render", "--session", "b.png", "--out", "b.png"}).status == 2);
    w.json({"render", "--session", "two/a.png", "--no-metadata", "--out", "c.png"});
    const Outcome none = w.run({"info", "--session", "c.png"});
    CHECK(none.status == 1);
    CHECK(none.err.find("carries no session") != std::string::npos);
    std::string bytes = w.read("b.png");
    bytes[bytes.find("pellucid:session") + 40] ^= 1;
    w.write("d.png", bytes);
    CHECK(w.run({"info", "--session", "d.png"}).status == 1);
}

TEST_CASE("layers of a picture are written beside it or alone, and sum to it", "[cli][picture-text]") {
    const Workshop w;
    const Words look = kKnee + Words{"--tf", "tents:3", "--shading", "--background", "transparent"};
    const json both = w.json(look + Words{"--layers", "l.exr", "--out", "a.exr"});
    CHECK(both["layers"] == "l.exr");
    CHECK(both["file"] == "a.exr");
    // The channels R, G, B, A are the picture.
    const Image a = readImage(w.path("a.exr").string()), l = readImage(w.path("l.exr").string());
    REQUIRE(a.rgba.size() == l.rgba.size());
    for (std::size_t i = 0; i < a.rgba.size(); ++i) REQUIRE(l.rgba[i] == Approx(a.rgba[i]).margin(1e-5));

    const json alone = w.json(look + Words{"--layers", "layers"});
    CHECK_FALSE(alone.contains("file"));
    const json index = json::parse(w.read("layers/layers.json"));
    REQUIRE(index["features"].size() == 3);
    std::vector<double> sum(40 * 30, 0);
    for (const json& feature : index["features"]) {
        const Image mask = readImage(w.path("layers/" + feature["mask"].get<std::string>()).string());
        for (std::size_t p = 0; p < sum.size(); ++p) sum[p] += static_cast<double>(mask.rgba[4 * p]);
    }
    // tents:3 leaves nothing without a feature. 16 bits each of three, 8 of the picture.
    double most = 0;
    for (std::size_t p = 0; p < sum.size(); ++p)
        most = std::max(most, std::abs(sum[p] - static_cast<double>(a.rgba[4 * p + 3])));
    CHECK(most < 1e-3);
    CHECK(w.list() == Words{"a.exr", "l.exr", "layers"});
}

TEST_CASE("layers are refused where a picture has none", "[cli][picture-text]") {
    const Workshop w;
    const auto refused = [&](const Words& more, const std::string& why) {
        const Outcome outcome = w.run(kKnee + more);
        INFO(outcome.err);
        CHECK(outcome.status == 2);
        CHECK(outcome.err.find(why) != std::string::npos);
        CHECK(w.list().empty());
    };
    refused({}, "--out");
    refused({"--layers", "l.exr", "--slice", "x:0.5"}, "slice");
    refused({"--layers", "l.exr", "--mode", "mip"}, "emission and absorption");
    refused({"--layers", "l.exr", "--preview"}, "quick picture");
    refused({"--layers", "l.png"}, ".exr");
    refused({"--layers", "l.exr", "--out", "l.exr"}, "l.exr");
}

TEST_CASE("the command in a picture names files as seen from the present folder", "[cli][picture-text]") {
    const std::string here = std::filesystem::current_path().string();
    const Words words{"render",
                      here + "/data/a b.nrrd",
                      "--out",
                      "x.png",
                      "--variable",
                      "y=" + here + "/c.nrrd",
                      "--tf=" + here + "/t.tf.json",
                      "--json",
                      "--memory",
                      "4",
                      "--background",
                      "#fff",
                      "--caption"};
    cli::keepCommandLine("pellucid-cli", words);
    CHECK(cli::pictureCommand("--out", "picture.png") ==
          "pellucid-cli render 'data/a b.nrrd' --variable y=c.nrrd --tf=t.tf.json --background '#fff' "
          "--out picture.png");
}
