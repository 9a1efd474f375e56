// The overlay of a session: read, laid over the volume, kept from one resolving to the next, saved.
#include <catch2/catch.hpp>

#include <filesystem>

#include <nlohmann/json.hpp>

#include "session/overlay_file.h"
#include "session/scene.h"
#include "session/session_json.h"
#include "session/slice_input.h"
#include "support/temp_folder.h"
#include "support/volumes.h"
#include "tf/shapes.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// An anatomy of a patient and maps that fit it or not, as files.
struct Files {
    TempFolder folder;
    Geometry head{{12, 12, 12}, Vec3(2), Vec3(-11), Mat3(1), WorldAxes::Patient};

    std::string write(const std::string& name, const Geometry& geometry,
                      const std::function<double(const Vec3& world)>& value) const {
        const auto volume = volumeFrom(
            geometry, [&](int i, int j, int k) { return value(geometry.worldFromVoxel(Vec3(i, j, k))); }, std::nullopt);
        const std::string path = folder.path(name);
        writeNrrd(*volume, path);
        return path;
    }
    std::string anatomy() const {
        return write("head.nrrd", head, [](const Vec3& w) { return std::max(0.0, 12 - glm::length(w)); });
    }
    /// Values from −6 to 6 along x.
    std::string map(const Vec3& shift = Vec3(0)) const {
        const Geometry g{{7, 7, 7}, Vec3(3), Vec3(-9) + shift, Mat3(1), WorldAxes::Patient};
        return write("map.nrrd", g, [&](const Vec3& w) { return (w.x - shift.x) * 6 / 9; });
    }
};

Session sessionWith(const std::string& volume, const std::string& overlay) {
    VolumeSource source;
    source.path = volume;
    Session session = sessionOf(source);
    session.setTf(tents(2));
    session.overlay.edit([&](OverlayView& o) { o.source.path = overlay; });
    return session;
}

std::string problemOf(const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

} // namespace

TEST_CASE("a session's overlay is in its pictures and slices, and in no figure", "[overlay]") {
    const Files files;
    const Scene scene = resolve(sessionWith(files.anatomy(), files.map()), {});
    REQUIRE(scene.overlay);
    CHECK(scene.overlay->valueAt({3, 1, 1}).value() == Approx(2)); // 3·6/9
    CHECK(scene.overlay->look.twoSided);
    CHECK(scene.overlay->geometry.d0() == 2); // opacities are of the volume's d0
    CHECK(scene.overlay->notices.empty());
    CHECK(pictureInput(scene, 8, 8).settings.overlay == scene.overlay);
    CHECK(sliceInput(scene).settings.overlay == scene.overlay);
    CHECK(plainPictureInput(scene, 8, 8).settings.overlay == nullptr);

    Session without = scene.session;
    without.overlay = OverlayView{};
    const Scene alone = resolve(without, scene);
    CHECK(alone.overlay == nullptr);
    CHECK(measureInput(alone) == measureInput(scene));
}

TEST_CASE("an overlay in another unit lies where it would lie in that of the volume", "[overlay]") {
    const Files files;
    Geometry cells{{12, 12, 12}, Vec3(2), Vec3(-11)}, map{{7, 7, 7}, Vec3(3000), Vec3(-9000)};
    cells.lengthUnit = LengthUnit::Micrometre;
    map.lengthUnit = LengthUnit::Nanometre;
    const auto ball = [](const Vec3& w) { return std::max(0.0, 12 - glm::length(w)); };
    const std::string volume = files.write("cells.nrrd", cells, ball);
    const Session session = sessionWith(volume, files.write("map.nrrd", map, [](const Vec3& w) { return w.x / 1500; }));
    const Scene scene = resolve(session, {});
    REQUIRE(scene.overlay);
    CHECK(scene.overlay->valueAt({3, 1, 1}).value() == Approx(2)); // 3 µm are 3000 nm
    CHECK(glm::length(scene.overlay->geometry.spacing - Vec3(3)) < 1e-12);
    // The same numbers in another unit are another place.
    cells.lengthUnit = LengthUnit::Nanometre;
    cells.spacing *= 1000;
    cells.origin *= 1000;
    Session other = sessionWith(files.write("fine.nrrd", cells, ball), files.folder.path("map.nrrd"));
    CHECK(resolve(other, scene).overlay->geometry.spacing == Vec3(3000));
}

TEST_CASE("voxels of an overlay are read once, and its look made anew", "[overlay]") {
    const Files files;
    const Scene scene = resolve(sessionWith(files.anatomy(), files.map()), {});
    Session other = scene.session;
    other.setTf(tents(3));
    CHECK(resolve(other, scene).overlay == scene.overlay);

    other.overlay.edit([](OverlayView& o) {
        o.threshold = 3;
        o.opacity = 0.5;
    });
    const Scene changed = resolve(other, scene);
    CHECK(changed.overlay->volume == scene.overlay->volume);
    CHECK(changed.overlay->look.threshold == 3);
    CHECK(changed.overlay->look.top == scene.overlay->look.top);
    CHECK(changed.overlay->tf.opacity(1) == Approx(0.5));
    CHECK(changed.overlay->tf.opacity((2.9 + 6) / 12) == 0);

    // One side where both signs were proposed: a tenth of the largest value, which is 6.
    other.overlay.edit([](OverlayView& o) {
        o.sides = OverlayView::Sides::One;
        o.threshold.reset();
    });
    CHECK(resolve(other, changed).overlay->look == OverlayLook{false, 0.6, 6});

    // A curve of its own: tents:1 over all values, whose peak is that of `opacity`.
    other.overlay.edit([](OverlayView& o) {
        o.curve = tents(1, 0.3);
        o.opacity.reset();
    });
    CHECK(resolve(other, changed).overlay->tf.opacity(0.5) == Approx(0.3));
    other.overlay.edit([](OverlayView& o) { o.opacity = 0.6; });
    CHECK(resolve(other, changed).overlay->tf.opacity(0.5) == Approx(0.6));

    other.overlay.edit([](OverlayView& o) { o.shown = false; });
    CHECK(resolve(other, changed).overlay == nullptr);
}

TEST_CASE("an overlay that cannot be laid over the volume is told with the reason", "[overlay]") {
    const Files files;
    const std::string head = files.anatomy();
    // The head ends at 12 in the world, the map begins at 100 − 10.5.
    const std::string apart = problemOf([&] { resolve(sessionWith(head, files.map({100, 0, 0})), {}); });
    CHECK(apart.find("do not meet") != std::string::npos);
    CHECK(apart.find("77.5 mm") != std::string::npos);
    CHECK(apart.find("map.nrrd") != std::string::npos);
    const std::string flat = files.write("flat.nrrd", files.head, [](const Vec3&) { return 4.0; });
    CHECK(problemOf([&] { resolve(sessionWith(head, flat), {}); }).find("the same") != std::string::npos);
    CHECK(problemOf([&] { resolve(sessionWith(head, "gone.nrrd"), {}); }).find("gone.nrrd") != std::string::npos);

    Session mapped = sessionWith(head, files.map());
    mapped.overlay.edit([](OverlayView& o) { o.colorMap = "mud"; });
    CHECK(problemOf([&] { resolve(mapped, {}); }).find("mud") != std::string::npos);
}

TEST_CASE("a file without a place lies in the middle of the volume, and that is said", "[overlay]") {
    const Files files;
    const std::string nowhere =
        files.write("nowhere.nrrd", geometryOf({4, 4, 4}, Vec3(2)), [](const Vec3& w) { return w.x; });
    const Scene scene = resolve(sessionWith(files.anatomy(), nowhere), {});
    CHECK(scene.overlay->byCentres);
    REQUIRE(scene.overlay->notices.size() == 1);
    CHECK(scene.overlay->notices[0].find("centred") != std::string::npos);
    CHECK(scene.overlay->valueAt(Vec3(0)).value() == Approx(3)); // 0, 2, 4, 6 along x
}

TEST_CASE("an overlay goes through a session file", "[overlay]") {
    const Files files;
    Session session = sessionWith(files.anatomy(), files.map());
    session.overlay.edit([](OverlayView& o) {
        o.sides = OverlayView::Sides::Two;
        o.threshold = 3.1;
        o.top = 5;
        o.colorMap = "blue-orange";
        o.opacity = 0.25;
        o.curve = tents(2, 0.4);
        o.source.component = 1;
    });
    const std::string path = files.folder.path("s.pellucid.json");
    writeSession(session, path);
    CHECK(*readSession(path).session.overlay == *session.overlay);
    // Beside the session: named by where it lies from there.
    const nlohmann::json written =
        jsonFromSession(session, std::filesystem::path(path).parent_path().string(), DataPaths::Relative);
    CHECK(written["overlay"]["source"]["path"] == "map.nrrd");
}
