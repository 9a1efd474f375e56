#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "support/temp_folder.h"
#include "tf/formats/tf_file.h"
#include "tf/formats/voreen_tfi.h"

using namespace pellucid;

namespace {

std::string key(const std::string& x, const std::string& rgba, const std::string& more = "") {
    return "<key type=\"TransFuncMappingKey\"><intensity value=\"" + x + "\"/><split value=\"" +
           (more.empty() ? "false" : "true") + "\"/><colorL " + rgba + "/>" + more + "</key>\n";
}

std::string rgba(int r, int g, int b, int a) {
    return "r=\"" + std::to_string(r) + "\" g=\"" + std::to_string(g) + "\" b=\"" + std::to_string(b) + "\" a=\"" +
           std::to_string(a) + "\"";
}

/// A document on lines: 1 the root, 2 the function, 3 `settings`, 4 Keys, 5 and on the keys.
std::string document(const std::string& keys, const std::string& settings = "") {
    return "<VoreenData version=\"1\">\n<TransFuncIntensity type=\"TransFuncIntensity\">\n" + settings + "\n<Keys>\n" +
           keys + "</Keys></TransFuncIntensity></VoreenData>\n";
}

const std::string kTent =
    key("0.2", rgba(255, 0, 0, 0)) + key("0.4", rgba(255, 102, 0, 51)) + key("0.6", rgba(255, 0, 0, 0));

TransferFunction tfOf(const std::string& keys, const std::string& settings = "") {
    return tfFromVoreen(document(keys, settings), "a.tfi");
}

std::string messageOf(const std::string& text) {
    try {
        tfFromVoreen(text, "a.tfi");
    } catch (const FileError& e) {
        return e.what();
    }
    return "";
}

} // namespace

TEST_CASE("keys of Voreen become control points and features", "[tf][tfi]") {
    const TransferFunction tf = tfOf(kTent);
    REQUIRE(tf.points.size() == 3);
    CHECK(tf.points[0] == ControlPoint{0.2, 0, {1, 0, 0}, true, {}});
    CHECK(tf.points[1] == ControlPoint{0.4, 51 / 255.0, {1, 102 / 255.0, 0}, false, {}});
    CHECK_FALSE(tf.range); // without a domain it is of whatever the window is
    REQUIRE(tf.features.size() == 1);
    CHECK(tf.features[0].a == 0.2);
    CHECK(tf.features[0].b == 0.6);
    CHECK(tf.features[0].color == tf.points[1].color);
}

TEST_CASE("a domain in data units is the range, 0 to 1 is none", "[tf][tfi]") {
    CHECK_FALSE(tfOf(kTent, "<domain x=\"0\" y=\"1\"/>").range);
    CHECK(tfOf(kTent, "<domain x=\"-1000\" y=\"249.5\"/>").range == ValueRange{-1000, 249.5});
}

TEST_CASE("a split key is a step, and the outer keys' opacities hold beyond them", "[tf][tfi]") {
    const TransferFunction tf = tfOf(key("0.25", rgba(0, 0, 255, 51), "<colorR " + rgba(0, 255, 0, 102) + "/>") +
                                     key("0.75", rgba(0, 0, 0, 255)));
    REQUIRE(tf.points.size() == 5); // 0, the two of the step, the last key, 1
    CHECK(tf.points[1].x == tf.points[2].x);
    CHECK(tf.opacity(0.1) == Approx(0.2));  // 51/255, held
    CHECK(tf.opacity(0.25) == Approx(0.4)); // the right side of the step
    CHECK(tf.opacity(0.5) == Approx(0.7));  // half way from 0.4 to 1
    CHECK(tf.opacity(0.9) == 1.0);          // held
    CHECK(tf.color(0.5).g == Approx(0.5));  // half way from green to black
    CHECK(tf.features.size() == 1);
}

TEST_CASE("opacity is 0 outside the threshold", "[tf][tfi]") {
    const TransferFunction tf = tfOf(kTent, "<threshold x=\"0.3\" y=\"0.5\"/>");
    CHECK(tf.opacity(0.2999) == 0);
    CHECK(tf.opacity(0.3) == Approx(0.1)); // half of the tent's 0.2
    CHECK(tf.opacity(0.4999) == Approx(0.1).margin(1e-3));
    CHECK(tf.opacity(0.5001) == 0);
    REQUIRE(tf.features.size() == 1);
    CHECK(tf.features[0].a == 0.3);
    CHECK(tf.features[0].b == 0.5);
    // At keys no point is added twice: those at 0.2 and 0.6 stay alone.
    CHECK(tfOf(kTent, "<threshold x=\"0.4\" y=\"0.4\"/>").opacity(0.41) == 0);
}

TEST_CASE("a gamma bends the way to the keys", "[tf][tfi]") {
    // f(s^2): the tent's peak at 0.4 comes to sqrt(0.4), and at s = 0.6 there is f(0.36) = 0.2·(0.36 − 0.2)/0.2.
    const TransferFunction tf = tfOf(kTent, "<gammaValue value=\"2\"/>");
    CHECK(tf.opacity(std::sqrt(0.4)) == Approx(0.2));
    CHECK(tf.opacity(0.6) == Approx(0.16).margin(2e-4));
    CHECK(tf.features[0].a == Approx(std::sqrt(0.2)));
}

TEST_CASE("alpha modes force the opacity", "[tf][tfi]") {
    CHECK(tfOf(kTent, "<alphaMode value=\"0\"/>").features.empty());
    CHECK(tfOf(kTent, "<alphaMode value=\"1\"/>").opacity(0.4) == Approx(0.2));
    CHECK(tfOf(kTent, "<alphaMode value=\"2\"/>").opacity(0.3) == 1);
    CHECK(tfOf(kTent, "<ignoreAlpha value=\"true\"/>").opacity(0.3) == 1);
    CHECK(tfOf(kTent, "<ignoreAlpha value=\"false\"/>").opacity(0.3) == Approx(0.1));
}

TEST_CASE("keys in any order, of any version, are read", "[tf][tfi]") {
    const TransferFunction tf = tfFromVoreen(
        "<VoreenData><TransFunc1DKeys><new/><Keys>" + key("0.6", rgba(255, 0, 0, 0)) + key("0.2", rgba(255, 0, 0, 0)) +
            key("0.4", rgba(255, 102, 0, 51)) + "</Keys></TransFunc1DKeys></VoreenData>",
        "a.tfi");
    CHECK(tf == tfOf(kTent));
}

TEST_CASE("a broken file of Voreen is refused with its place", "[tf][tfi]") {
    using Catch::Contains;
    CHECK_THAT(messageOf(""), Contains("not valid XML"));
    CHECK_THAT(messageOf("<VoreenData>\n<Keys>\n</VoreenData>"), Contains("not valid XML") && Contains("line 3"));
    CHECK_THAT(messageOf("<VoreenData/>"), Contains("no transfer function"));
    CHECK_THAT(messageOf(document("")), Contains("no keys"));
    for (const char* x : {"nan", "inf", "-inf", "1e999", "0,5", "", "abc", "0x1"})
        CHECK_THAT(messageOf(document(kTent + key(x, rgba(0, 0, 0, 0)))),
                   Contains("is not a number") && Contains("line 8, 'intensity'"));
    CHECK_THAT(messageOf(document(key("1.5", rgba(0, 0, 0, 0)))), Contains("not between 0 and 1"));
    CHECK_THAT(messageOf(document(key("0.5", rgba(0, 300, 0, 0)))), Contains("not between 0 and 255"));
    CHECK_THAT(messageOf(document(key("0.5", "r=\"1\" g=\"2\" b=\"3\""))), Contains("attribute a is missing"));
    CHECK_THAT(messageOf(document("<key><colorL r=\"0\"/></key>")), Contains("intensity is missing"));
    CHECK_THAT(messageOf(document(key("0.5", rgba(0, 0, 0, 0), "<x/>"))), Contains("colorR is missing"));
    CHECK_THAT(messageOf(document(kTent, "<domain x=\"3\" y=\"3\"/>")), Contains("domain") && Contains("line 3"));
    CHECK_THAT(messageOf(document(kTent, "<domain x=\"-1e308\" y=\"1e308\"/>")), Contains("domain"));
    CHECK_THAT(messageOf(document(kTent, "<threshold x=\"0.6\" y=\"0.5\"/>")), Contains("threshold"));
    CHECK_THAT(messageOf(document(kTent, "<gammaValue value=\"0\"/>")), Contains("gamma"));
    CHECK_THAT(messageOf(document(kTent, "<alphaMode value=\"7\"/>")), Contains("not between 0 and 2"));
    std::string many;
    for (int i = 0; i < 5000; ++i) many += key("0.5", rgba(0, 0, 0, 0));
    CHECK_THAT(messageOf(document(many)), Contains("more than 4096 keys"));
    std::string deep;
    for (int i = 0; i < 100000; ++i) deep += "<a>";
    CHECK_THAT(messageOf(deep), Contains("not valid XML"));
}

TEST_CASE("a transfer function is read by its suffix", "[tf][tfi]") {
    const test::TempFolder folder;
    CHECK(loadTf(folder.write("a.TFI", document(kTent))) == tfOf(kTent));
    CHECK(hasTfSuffix("x/a.TFI"));
    CHECK(hasTfSuffix("a.tf.json"));
    CHECK_FALSE(hasTfSuffix("a.json"));
    CHECK_THROWS_AS(loadTf(folder.write("b.tf.json", document(kTent))), Error); // not JSON
    CHECK_THROWS_AS(loadTf(folder.path("none.tfi")), FileError);
}

TEST_CASE("files as Voreen wrote them are read", "[tf][tfi][real]") {
    const std::string folder = std::string(PELLUCID_SHARED_DIR) + "/data/real/tfi/";
    if (!std::filesystem::exists(folder)) {
        WARN("SKIPPED: there is no " << folder);
        return;
    }
    const TransferFunction nucleon = loadTf(folder + "nucleon.tfi");
    CHECK(nucleon.points.size() == 12);
    CHECK(nucleon.range == ValueRange{0, 249});
    CHECK(nucleon.features.size() == 3);
    const TransferFunction split = loadTf(folder + "nucleon2.tfi"); // two of its six keys are split; the last holds
    CHECK(split.points.size() == 9);
    CHECK(split.features.size() == 3);
    CHECK(loadTf(folder + "102_Jet.tfi").features.size() == 1);
    CHECK(loadTf(folder + "walnut.tfi").range == ValueRange{0, 22526});
}
