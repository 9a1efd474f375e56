// Sessions as files: nothing is lost, and nothing that is wrong is believed.
#include <catch2/catch.hpp>

#include <filesystem>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_value.h"
#include "session/session_json.h"
#include "support/full_disk.h"
#include "support/random_sessions.h"
#include "support/temp_folder.h"

using namespace pellucid;
using namespace pellucid::test;
using nlohmann::json;

namespace {

constexpr const char* kFolder = "/some/folder";

json documentOf(const Session& session) {
    return json::parse(jsonFromSession(session, kFolder, DataPaths::Relative).dump());
}
Session sessionOfDocument(const json& document) { return sessionFromJson({document, "s.json"}, kFolder).session; }

std::string messageOf(const json& document) {
    try {
        sessionOfDocument(document);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

/// A session with something in every place that a file has.
Session full() {
    for (std::uint32_t n = 0;; ++n) {
        const Session s = randomSession(n);
        if (!s.isEmpty() && s.variable().source.raw && s.variable().window && s.camera && !s.runs->empty() &&
            !s.runs->front().history.empty() && s.variable().track.keys.size() > 1 &&
            !s.variable().track.keys.begin()->second->features.empty() &&
            !s.variable().track.keys.begin()->second->points.empty())
            return s;
    }
}

/// Pointers of all values of the document but those of other programs.
std::vector<std::string> placesIn(const json& document) {
    std::vector<std::string> all;
    const std::function<void(const json&, const std::string&)> visit = [&](const json& j, const std::string& at) {
        if (!at.empty()) all.push_back(at);
        if (j.is_object())
            for (const auto& [key, value] : j.items()) {
                if (!key.starts_with("x-")) visit(value, at + "/" + key);
            }
        if (j.is_array())
            for (std::size_t i = 0; i < j.size(); ++i) visit(j[i], at + "/" + std::to_string(i));
    };
    visit(document, "");
    return all;
}

} // namespace

TEST_CASE("a session comes back from its file exactly", "[session][json]") {
    for (std::uint32_t n = 0; n < 300; ++n) {
        INFO("session " << n);
        const Session session = randomSession(n);
        const Session back = sessionOfDocument(documentOf(session));
        REQUIRE(identical(back, session));
        REQUIRE(documentOf(back) == documentOf(session));
    }
    const TempFolder folder;
    const Session session = full();
    writeSession(session, folder.path("a.pellucid.json"));
    CHECK(identical(readSession(folder.path("a.pellucid.json")).session, session));
    CHECK(readSession(folder.path("a.pellucid.json")).notices.empty());
    CHECK(folder.fileCount() == 1);
}

TEST_CASE("the other projection's size of a camera is kept too", "[session][json]") {
    Session s;
    s.camera = Camera{Projection::Orthographic, {0, -5, 0}, {0, 0, 0}, {0, 0, 1}, 12.5, 7.25};
    CHECK(sessionOfDocument(documentOf(s)).camera == s.camera);
    s.camera->projection = Projection::Perspective;
    CHECK(sessionOfDocument(documentOf(s)).camera == s.camera);
}

TEST_CASE("keys of other programs are kept where that is promised", "[session][json]") {
    json j = documentOf(full());
    const std::vector<std::string> places{"", "/variables/0", "/variables/0/transfer_functions/0/tf",
                                          "/variables/0/transfer_functions/0/tf/points/0",
                                          "/variables/0/transfer_functions/0/tf/features/0"};
    for (const std::string& place : places) j[json::json_pointer(place)]["x-theirs"] = {{"a", {1, "b", nullptr}}};
    const json back = documentOf(sessionOfDocument(j));
    for (const std::string& place : places) {
        INFO(place);
        CHECK(back[json::json_pointer(place)]["x-theirs"] == j[json::json_pointer(place)]["x-theirs"]);
    }
    CHECK(back == j);
}

TEST_CASE("another format and a newer version are refused in words", "[session][json]") {
    json j = documentOf(full());
    j["version"] = 2;
    CHECK_THAT(messageOf(j), Catch::Contains("version 2 is newer than this program knows") &&
                                 Catch::Contains("s.json at /version") && Catch::Contains("update Pellucid"));
    j["version"] = 1;
    j["format"] = "pellucid-tf";
    CHECK_THAT(messageOf(j), Catch::Contains("s.json at /format") && Catch::Contains("give a session file"));
    const TempFolder folder;
    CHECK_THROWS_AS(readSession(folder.path("none.json")), FileError);
    CHECK_THROWS_AS(readSession(folder.write("bad.json", "{\"format\":")), FileError);
}

TEST_CASE("no value of another type is believed", "[session][json]") {
    const std::vector<json> others{json(), json(true), json("nonsense"), json(-7.25), json::array(), json::object()};
    const auto sameType = [](const json& a, const json& b) {
        return a.type() == b.type() || (a.is_number() && b.is_number());
    };
    std::size_t tried = 0;
    std::vector<json> documents{documentOf(full())};
    for (std::uint32_t n = 0; n < 6; ++n) documents.push_back(documentOf(randomSession(n)));
    for (const json& document : documents)
        for (const std::string& place : placesIn(document))
            for (const json& other : others) {
                const json::json_pointer pointer(place);
                if (sameType(document[pointer], other)) continue;
                // A colour is a text or a list, of three numbers.
                json mutated = document;
                mutated[pointer] = other;
                INFO(place << " is " << other.dump());
                std::string where;
                try {
                    sessionOfDocument(mutated);
                } catch (const Error& e) {
                    where = e.where();
                }
                ++tried;
                REQUIRE(where.starts_with("s.json at /"));
                const std::string said = where.substr(std::string("s.json at ").size());
                REQUIRE(place.starts_with(said));
            }
    CHECK(tried > 1000);
}

TEST_CASE("keyframes are kept, files from before there were any are read, and wrong ones are refused",
          "[session][json][film]") {
    Session session = full();
    Keyframe first{0.5, "front", Easing::Smooth}, second{2};
    first.state.tf = *session.tf();
    first.state.frame = 3;
    second.state.camera.eye = {1, 2, 30};
    second.state.light.on = true;
    session.keyframes = Keyframes{first, second};
    json document = documentOf(session);
    CHECK(*sessionOfDocument(document).keyframes == Keyframes{first, second});
    const auto placeOfError = [](const json& wrong) {
        try {
            sessionOfDocument(wrong);
        } catch (const Error& e) {
            return e.where();
        }
        return std::string();
    };
    json wrong = document;
    wrong["keyframes"][1]["time"] = 0.5;
    CHECK(placeOfError(wrong) == "s.json at /keyframes/1/time");
    wrong = document;
    wrong["keyframes"][0]["easing"] = "softly";
    CHECK(placeOfError(wrong) == "s.json at /keyframes/0/easing");
    document.erase("keyframes");
    const Session before = sessionOfDocument(document);
    CHECK(before.keyframes->empty());
    session.keyframes = Keyframes();
    CHECK(before == session);
}

TEST_CASE("a number out of its range is refused with its place, or makes a session that is as good as any",
          "[session][json]") {
    std::size_t refused = 0, tried = 0;
    for (std::uint32_t n = 0; n < 12; ++n) {
        const json document = n == 0 ? documentOf(full()) : documentOf(randomSession(n));
        for (const std::string& place : placesIn(document)) {
            const json::json_pointer pointer(place);
            if (!document[pointer].is_number()) continue;
            for (const json& other : {json(-1), json(-1e308), json(1e308), json(0), json(0.5), json(1), json(INT64_MIN),
                                      json(UINT64_MAX), json(2.0000001), json(-5e-324)}) {
                json mutated = document;
                mutated[pointer] = other;
                INFO(place << " is " << other.dump());
                ++tried;
                try {
                    const Session session = sessionOfDocument(mutated);
                    REQUIRE(identical(sessionOfDocument(documentOf(session)), session));
                } catch (const Error& e) {
                    ++refused;
                    REQUIRE(e.where().starts_with("s.json at /"));
                }
            }
        }
    }
    CHECK(refused > 500);
    CHECK(tried > refused);
}

TEST_CASE("a key that is missing is named, or has a default", "[session][json]") {
    const json document = documentOf(full());
    for (const std::string& place : placesIn(document)) {
        const json::json_pointer pointer(place);
        if (!document[pointer.parent_pointer()].is_object()) continue;
        json mutated = document;
        mutated[pointer.parent_pointer()].erase(pointer.back());
        INFO(place);
        try {
            sessionOfDocument(mutated);
        } catch (const Error& e) {
            REQUIRE(e.where().starts_with("s.json"));
            CHECK_THAT(e.what(), Catch::Contains(pointer.back()) || Catch::Contains("missing"));
        }
    }
    CHECK(sessionOfDocument(json{{"format", "pellucid-session"}, {"version", 1}, {"variables", json::array()}}) ==
          Session{});
}

TEST_CASE("files that know only whether there is shading keep their meaning", "[session][json]") {
    const auto displayOf = [](const json& display) {
        json j = documentOf(Session{});
        j["display"] = display;
        return *sessionOfDocument(j).display;
    };
    Light lit;
    lit.on = true;
    CHECK(displayOf({{"shading", true}}).light == lit);
    CHECK_FALSE(displayOf({{"shading", false}}).light.on);
    CHECK_FALSE(displayOf(json::object()).light.on); // light is on where a window opens a volume, not in files
    CHECK(displayOf({{"shading", true}, {"light", {{"on", false}}}}).light == Light{});
}

TEST_CASE("wrong sessions are refused", "[session][json]") {
    const json good = documentOf(full());
    const auto with = [&](const char* pointer, json value) {
        json j = good;
        j[json::json_pointer(pointer)] = std::move(value);
        return messageOf(j);
    };
    CHECK_THAT(with("/camera/center", good["camera"]["eye"]), Catch::Contains("/camera"));
    CHECK_THAT(with("/camera/up", {0, 0, 0}), Catch::Contains("/camera"));
    CHECK_THAT(with("/clip/hi", good["clip"]["lo"]), Catch::Contains("/clip"));
    CHECK_THAT(with("/clip/planes", {{{"normal", {0, 0, 0}}, {"offset", 1}}}), Catch::Contains("/clip/planes/0"));
    CHECK_THAT(with("/display/mode", "xray"), Catch::Contains("/display/mode"));
    CHECK_THAT(with("/display/light/occlusion", 2), Catch::Contains("/display/light/occlusion"));
    CHECK_THAT(with("/variables/0/window", {1, 1}), Catch::Contains("/variables/0/window"));
    CHECK_THAT(with("/variables/0/window", {-1.7e308, 1.7e308}), Catch::Contains("/variables/0/window"));
    CHECK_THAT(with("/measure/sigma", 9), Catch::Contains("/measure/sigma"));
    CHECK_THAT(with("/measure/engine", "cuda"), Catch::Contains("/measure/engine") && Catch::Contains("cpu"));
    CHECK_THAT(with("/optimize/method", "simplex"), Catch::Contains("/optimize/method"));
    CHECK_THAT(with("/optimize/step", 0), Catch::Contains("/optimize"));
    CHECK_THAT(with("/adapt/mode", "always"), Catch::Contains("/adapt/mode"));
    CHECK_THAT(with("/adapt/coherence", "much"), Catch::Contains("/adapt/coherence"));
    CHECK_THAT(with("/adapt/coherence", -1), Catch::Contains("/adapt/coherence"));
    CHECK_THAT(with("/hsb/hue_from", 1e6), Catch::Contains("/hsb/hue_from"));
    CHECK_THAT(with("/ground/relief", 2), Catch::Contains("/ground/relief"));
    CHECK_THAT(with("/features/1/id", good["features"][0]["id"]), Catch::Contains("/features/1/id"));
    json two = good;
    two["variables"].push_back(two["variables"][0]);
    CHECK_THAT(messageOf(two), Catch::Contains("a name of its own"));
}

TEST_CASE("session and data can be moved together", "[session][json]") {
    const TempFolder folder;
    namespace fs = std::filesystem;
    fs::create_directories(folder.path("here/data"));
    fs::create_directories(folder.path("here/project"));
    folder.write("here/data/v.raw", std::string(8, '\1'));
    Session s;
    Variable v;
    v.source.path = folder.path("here/data/v.raw");
    s.variables = std::vector<Variable>{v};
    writeSession(s, folder.path("here/project/a.pellucid.json"));
    CHECK(readSession(folder.path("here/project/a.pellucid.json")).session == s);

    fs::rename(folder.path("here"), folder.path("there"));
    const SessionFile moved = readSession(folder.path("there/project/a.pellucid.json"));
    CHECK(moved.session.variable().source.path == folder.path("there/data/v.raw"));
    CHECK(moved.notices.empty());

    // Through a link to the folder, whose parent is not where the data is
    fs::create_directory_symlink(folder.path("there/project"), folder.path("link"));
    CHECK(fs::equivalent(readSession(folder.path("link/a.pellucid.json")).session.variable().source.path,
                         folder.path("there/data/v.raw")));

    writeSession(s, folder.path("absolute.pellucid.json"), DataPaths::Absolute);
    const json document = json::parse(std::ifstream(folder.path("absolute.pellucid.json")));
    CHECK(document["variables"][0]["source"]["path"] == folder.path("here/data/v.raw"));
}

TEST_CASE("a data file that is not the one that was saved is noticed", "[session][json]") {
    const TempFolder folder;
    Session s;
    Variable v;
    v.source.path = folder.write("v.raw", "12345678");
    s.variables = std::vector<Variable>{v};
    writeSession(s, folder.path("a.pellucid.json"));
    CHECK(readSession(folder.path("a.pellucid.json")).notices.empty());
    folder.write("v.raw", "12345679"); // as many bytes
    std::filesystem::last_write_time(v.source.path,
                                     std::filesystem::file_time_type::clock::now() + std::chrono::hours(1));
    const SessionFile changed = readSession(folder.path("a.pellucid.json"));
    REQUIRE(changed.notices.size() == 1);
    CHECK_THAT(changed.notices[0], Catch::Contains("v.raw") && Catch::Contains("changed"));
    CHECK(changed.session == s);
    std::filesystem::remove(v.source.path); // to be told when it is opened
    CHECK(readSession(folder.path("a.pellucid.json")).notices.empty());
}

TEST_CASE("data beside its header is watched too", "[session][json]") {
    const TempFolder folder;
    Session s;
    Variable v;
    v.source.path = folder.write("v.mhd", "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
                                          "ElementDataFile = v.data\n");
    folder.write("v.data", "12345678");
    s.variables = std::vector<Variable>{v};
    writeSession(s, folder.path("a.pellucid.json"));
    CHECK(readSession(folder.path("a.pellucid.json")).notices.empty());
    folder.write("v.data", "12345679");
    std::filesystem::last_write_time(folder.path("v.data"),
                                     std::filesystem::file_time_type::clock::now() + std::chrono::hours(1));
    CHECK(readSession(folder.path("a.pellucid.json")).notices.size() == 1);
}

TEST_CASE("a data file whose name is no text is refused in words", "[session][json]") {
    const TempFolder folder;
    Session s;
    Variable v;
    v.source.path = folder.path("\xff\xfe.raw");
    s.variables = std::vector<Variable>{v};
    CHECK_THROWS_AS(writeSession(s, folder.path("a.pellucid.json")), FileError);
    CHECK(folder.fileCount() == 0);
}

TEST_CASE("a session that cannot be saved leaves the one that was there", "[session][json]") {
    const TempFolder folder;
    const std::string path = folder.path("a.pellucid.json");
    Session s;
    writeSession(s, path);
    const std::string before = readText(path);
    s.frame = 7;
    for (const std::size_t room : {std::size_t{0}, before.size() / 2}) {
        const FullDisk disk(room);
        CHECK_THROWS_AS(writeSession(s, path), FileError);
    }
    CHECK(readText(path) == before);
    CHECK(folder.fileCount() == 1);
    CHECK_THROWS_AS(writeSession(s, folder.path("none/a.pellucid.json")), FileError);
    writeSession(s, path);
    CHECK(readSession(path).session.frame == 7);
}

TEST_CASE("features that a hand has written without identities get them", "[session][json]") {
    const json tf = {{"format", "pellucid-tf"},
                     {"version", 1},
                     {"points", json::array()},
                     {"features", {{{"name", "a"}, {"range", {0, 0.5}}, {"color", "#ff0000"}}}}};
    const json j = {
        {"format", "pellucid-session"},
        {"version", 1},
        {"variables",
         {{{"name", "x"}, {"source", {{"sample", "shells"}}}, {"transfer_functions", {{{"frame", 0}, {"tf", tf}}}}}}},
        {"features", {{{"id", 3}, {"target", 1}}}}};
    CHECK(sessionOfDocument(j).tf()->features[0].id == 4);
}
