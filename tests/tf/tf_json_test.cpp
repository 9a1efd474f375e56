#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "support/temp_folder.h"
#include "tf/formats/tf_json.h"

using namespace pellucid;
using nlohmann::json;

namespace {

json good() {
    return json::parse(R"({"format":"pellucid-tf","version":1,"range":[-1000,2000],"comment":"mine",
        "points":[{"x":0.1,"opacity":0.0,"color":"#ff8800","fixed":true,"label":{"a":1}},{"x":0.2,"opacity":0.5,"color":"#ff8800"},
                  {"x":0.3,"opacity":0,"color":"#ff8800"}],
        "features":[{"name":"dentine","range":[0.1,0.3],"color":"#ff8800","weight":2}]})");
}

std::string messageOf(const json& j) {
    try {
        tfFromJson(j, "file.json");
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

} // namespace

TEST_CASE("a transfer function file is read as the guide writes it", "[tf][json]") {
    const TransferFunction tf = tfFromJson(good(), "file");
    REQUIRE(tf.points.size() == 3);
    CHECK(tf.points[0].fixed);
    CHECK_FALSE(tf.points[1].fixed);
    CHECK(tf.points[1].opacity == 0.5);
    CHECK(tf.range == ValueRange{-1000, 2000});
    CHECK(tf.features[0].name == "dentine");
}

TEST_CASE("unknown keys are kept and written back", "[tf][json]") {
    const json back = jsonFromTf(tfFromJson(good(), "file"));
    CHECK(back["comment"] == "mine");
    CHECK(back["points"][0]["label"]["a"] == 1);
    CHECK(back["features"][0]["weight"] == 2);
    CHECK(tfFromJson(back, "again") == tfFromJson(good(), "file"));
}

TEST_CASE("a file without features gets those of its tents", "[tf][json]") {
    json j = good();
    j.erase("features");
    const TransferFunction tf = tfFromJson(j, "file");
    REQUIRE(tf.features.size() == 1);
    CHECK(tf.features[0].a == 0.1);
    CHECK(tf.features[0].b == 0.3);
}

TEST_CASE("a file that no program should choke on is refused", "[tf][json]") {
    const test::TempFolder folder;
    const auto messageOfFile = [&](const std::string& text) {
        const std::string path = folder.write("a.tf.json", text);
        try {
            readTf(path);
        } catch (const FileError& e) {
            CHECK(e.where() == path);
            return std::string(e.what());
        }
        return std::string();
    };
    const std::string head = R"({"format":"pellucid-tf","version":1,)";
    CHECK_THAT(messageOfFile("{"), Catch::Contains("not valid JSON"));
    CHECK_THAT(messageOfFile(head + R"("points":[{"x":1e999,"opacity":0,"color":"#000000"}]})"),
               Catch::Contains("too large"));
    CHECK_THAT(
        messageOfFile(head + R"("points":[],"more":)" + std::string(100000, '[') + std::string(100000, ']') + "}"),
        Catch::Contains("nested"));
    CHECK(messageOfFile(head + R"("points":[],"more":[[[[1]]]]})").empty());
}

TEST_CASE("a bad file is refused with the place and the reason", "[tf][json]") {
    const auto with = [](const char* pointer, json value) {
        json j = good();
        j[json::json_pointer(pointer)] = std::move(value);
        return j;
    };
    CHECK_THAT(messageOf(with("/format", "other")), Catch::Contains("file.json at /format"));
    CHECK_THAT(messageOf(with("/version", 2)), Catch::Contains("newer"));
    CHECK_THAT(messageOf(with("/version", "1")), Catch::Contains("/version"));
    CHECK_THAT(messageOf(with("/points/1/x", 1.5)), Catch::Contains("/points/1/x"));
    CHECK_THAT(messageOf(with("/points/1/x", nullptr)), Catch::Contains("/points/1/x"));
    CHECK_THAT(messageOf(with("/points/1/x", 0.05)), Catch::Contains("sorted"));
    CHECK_THAT(messageOf(with("/points/1/opacity", -0.1)), Catch::Contains("/points/1/opacity"));
    CHECK_THAT(messageOf(with("/points/1/color", "blue")), Catch::Contains("/points/1/color"));
    CHECK_THAT(messageOf(with("/points/0/fixed", 1)), Catch::Contains("/points/0/fixed"));
    CHECK_THAT(messageOf(with("/features/0/range", json::array({0.3, 0.1}))), Catch::Contains("/features/0/range"));
    CHECK_THAT(messageOf(with("/range", json::array({5, 5}))), Catch::Contains("/range"));
    CHECK_THAT(messageOf(with("/points", "none")), Catch::Contains("/points"));
    CHECK_THAT(messageOf(json::array()), Catch::Contains("object"));
    json missing = good();
    missing["points"][2].erase("opacity");
    CHECK_THAT(messageOf(missing), Catch::Contains("'opacity' is missing") && Catch::Contains("/points/2"));
}

TEST_CASE("colours that eight bits do not hold survive a round trip exactly", "[tf][json]") {
    TransferFunction tf = tents(2);
    tf.points[0].color = {0.1 + 0.2, 1.0 / 3, 5e-324};
    tf.points[1].color = {1.0 / 255, 254.0 / 255, 1}; // these they hold
    tf.features[0].color = {0.123456789012345678, 0, 1};
    const json j = jsonFromTf(tf);
    CHECK(j["points"][0]["color"].is_array());
    CHECK(j["points"][1]["color"] == "#01feff");
    CHECK(tfFromJson(json::parse(j.dump()), "file") == tf);

    const test::TempFolder folder;
    writeTf(tf, folder.path("a.tf.json"));
    CHECK(readTf(folder.path("a.tf.json")) == tf);
}

TEST_CASE("a colour may be three numbers", "[tf][json]") {
    json j = good();
    j["points"][1]["color"] = {0.25, 0, 1};
    CHECK(tfFromJson(j, "file").points[1].color == Rgb{0.25, 0, 1});
    for (const json& bad :
         {json::array({0.5, 0.5}), json::array({0, 0, 1.5}), json::array({0, 0, "1"}), json(7), json()}) {
        j["points"][1]["color"] = bad;
        CHECK_THAT(messageOf(j), Catch::Contains("/points/1/color"));
    }
}

TEST_CASE("identities are written where they are wanted, and never taken for foreign keys", "[tf][json]") {
    TransferFunction tf = tents(2);
    tf.features[0].id = 5;
    tf.features[1].extraJson = R"({"id":"D1"})";
    const auto again = [](const json& j, Identities identities) {
        return tfFromJson(JsonValue(j, "file"), identities);
    };
    const json kept = jsonFromTf(tf, Identities::Keep), dropped = jsonFromTf(tf);
    CHECK(again(kept, Identities::Keep).features[0].id == 5);
    CHECK(again(kept, Identities::Keep).features[1].id == 0);
    CHECK(again(kept, Identities::Keep) == tf);
    CHECK(again(dropped, Identities::Drop).features[0].id == 0);
    CHECK(again(dropped, Identities::Drop) == tf);
    CHECK(dropped["features"][1]["id"] == "D1");
}
