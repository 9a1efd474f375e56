// A volume that was opened coarser: the part that clipping leaves, in all its voxels, and back.
#include "gui_support.h"

#include <algorithm>

#include <QAction>
#include <QTemporaryDir>

#include "volume/loader.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

/// A file of 16³ voxels, of which every second along each axis is opened.
void openHalved(OpenWindow& w, const QTemporaryDir& folder) {
    VolumeSource source;
    source.path = folder.filePath("a.nrrd").toStdString();
    std::vector<std::uint8_t> values;
    for (int i = 0; i < 16 * 16 * 16; ++i) values.push_back(static_cast<std::uint8_t>(i % 251));
    writeNrrd(Volume({{16, 16, 16}}, values), source.path);
    source.downsample = 2;
    w.opening().openVolume(source);
    REQUIRE(waitFor([&] { return w.document().volume()->dims() == Int3(8, 8, 8); }));
    w.settle();
}

} // namespace

TEST_CASE("what the clip box leaves opens at full resolution, and the whole volume again", "[window][large]") {
    const QTemporaryDir folder;
    OpenWindow w;
    openHalved(w, folder);
    auto& region = w.child<QAction>("regionAction");
    auto& whole = w.child<QAction>("wholeVolumeAction");
    CHECK_FALSE(region.isEnabled()); // nothing is cut away
    CHECK_FALSE(whole.isEnabled());

    w.services().store().edit("Clip", {}, [](Session& session) {
        session.clipping.edit([](Clipping& c) { c.lo = {0.5, 0, 0}; });
    });
    REQUIRE(region.isEnabled());
    region.trigger();
    REQUIRE(waitFor([&] { return w.document().volume()->dims() == Int3(8, 16, 16); }));
    w.settle();
    CHECK(w.document().volume()->value(0) == 8); // voxel (8, 0, 0) of the file
    CHECK(w.document().volume()->geometry().origin == Vec3(8, 0, 0));
    CHECK(w.services().store().session().clipping->isNone());

    REQUIRE(whole.isEnabled());
    whole.trigger();
    REQUIRE(waitFor([&] { return w.document().volume()->dims() == Int3(16, 16, 16); }));
    w.settle();
    w.document().undo();
    REQUIRE(waitFor([&] { return w.document().volume()->dims() == Int3(8, 16, 16); }));
    w.document().undo();
    REQUIRE(waitFor([&] { return w.document().volume()->dims() == Int3(8, 8, 8); }));
    w.settle();
}

TEST_CASE("a coarser copy that is saved is said to be one, though its note was closed", "[window][large]") {
    const QTemporaryDir folder;
    OpenWindow w;
    openHalved(w, folder);
    w.services().notices().clear();
    QSignalSpy saved(&w.saving(), &SaveController::volumeSaved);
    w.saving().saveVolume({folder.filePath("b.nrrd")});
    REQUIRE(waitFor([&] { return saved.count() == 1; }));
    CHECK(std::ranges::any_of(w.services().notices().all(), [](const Notice& notice) {
        return notice.text.contains("Downsampled by 2 to 8 x 8 x 8 of 16 x 16 x 16 voxels");
    }));
}
