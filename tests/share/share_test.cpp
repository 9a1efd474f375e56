#include "share/share.h"

#include <filesystem>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <zlib.h>

#include "base/atomic_file.h"
#include "optimize/answer/visibility_words.h"
#include "render/image_renderer.h"
#include "session/workspace.h"
#include "share/page_text.h"
#include "support/temp_folder.h"
#include "support/text_parts.h"
#include "tf/transfer_function.h"

using namespace pellucid;
using namespace pellucid::test;
using nlohmann::json;

namespace {

Scene sampleScene(const std::string& tf = "tents:3", int size = 16) {
    VolumeSource source;
    source.path = "sample:shells";
    source.sampleSize = size;
    SceneInputs inputs;
    inputs.session = sessionOf(source);
    inputs.tf = tf;
    inputs.start = SceneInputs::Start::Tents;
    inputs.view = ViewAngles{30, 20, 1};
    return openScene(inputs);
}

ShareTask taskOf(const Scene& scene, const TempFolder& folder, const ShareSettings& settings = {}) {
    return {scene, pictureInput(scene, 8, 8).settings, settings, folder.path("page.html")};
}

struct Page {
    SharedPage said;
    std::string text;
    json scene;
    /// Between the first `from` and the next `to` behind it.
    std::string between(const std::string& from, const std::string& to) const {
        const std::size_t begin = text.find(from);
        REQUIRE(begin != std::string::npos);
        return text.substr(begin + from.size(), text.find(to, begin + from.size()) - begin - from.size());
    }
};

Page pageOf(const ShareTask& task) {
    Page page{makeShare(task), {}, {}};
    page.text = readText(task.path);
    page.scene = json::parse(page.between("<script type=\"application/json\" id=\"scene\">", "</script>"));
    return page;
}

} // namespace

TEST_CASE("a page says the scene that it shows", "[share]") {
    const TempFolder folder;
    Scene scene = sampleScene();
    scene.tf.features[1].hidden = true;
    const Page page = pageOf(taskOf(scene, folder));
    const json& s = page.scene;
    CHECK(s["format"] == "pellucid-page");
    CHECK(s["volume"]["dims"] == json({16, 16, 16}));
    CHECK(s["volume"]["factor"] == 1);
    const Camera camera = cameraFromJson(s["camera"], "page");
    CHECK((camera.eye == scene.camera.eye && camera.center == scene.camera.center && camera.up == scene.camera.up));
    CHECK(camera.fovY == scene.camera.fovY);
    const auto points = scene.tf.pointsWithEnds();
    REQUIRE(s["tf"]["points"].size() == points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        CHECK(s["tf"]["points"][i] ==
              json({points[i].x, points[i].opacity, points[i].color.r, points[i].color.g, points[i].color.b}));
    const MeasureInput input = measureInput(scene);
    Workspace workspace;
    const Measures measures = workspace.measure(input);
    for (std::size_t f = 0; f < 3; ++f) {
        const json& feature = s["tf"]["features"][f];
        CHECK(feature["name"] == scene.tf.features[f].name);
        CHECK(feature["range"] == json({scene.tf.features[f].a, scene.tf.features[f].b}));
        CHECK(feature["hidden"] == (f == 1));
        CHECK(feature["opacity"] == kDefaultPeak);
        CHECK(feature["vws"].get<double>() == Approx(measures.features[f].vws));
        CHECK(feature["visibility"].get<double>() == Approx(measures.features[f].visibility));
    }
    // The same in words, beside the picture and in its place.
    const std::string words = page.between("id=\"caption\">", "</p>"), alt = page.between("id=\"still\" alt=\"", "\"");
    for (const std::size_t f : {0u, 2u})
        CHECK(words.find(htmlText(percentText(measures.features[f].vws))) != std::string::npos);
    CHECK(words.find("Not drawn: " + scene.tf.features[1].name) != std::string::npos);
    CHECK(alt.find(page.scene["title"].get<std::string>()) != std::string::npos);
    const DensityCurve curve = workspace.densityCurve(input, limitsOf(scene.tf, *scene.session.goals));
    REQUIRE(s["density"]["points"].size() == curve.points.size());
    CHECK(s["density"]["points"][0]["opacity"] == json(curve.points[0].opacity));
    CHECK(page.said.hasDensity);
}

TEST_CASE("the voxels of a page unpack to those of the volume", "[share]") {
    const TempFolder folder;
    const Scene scene = sampleScene();
    const Page page = pageOf(taskOf(scene, folder));
    const std::string digits = page.between("<script type=\"text/plain\" id=\"voxels\">", "</script>");
    REQUIRE(page.scene["data"]["packed"] == page.said.packedBytes);
    CHECK(digits.size() == digitCount(page.said.packedBytes));
    CHECK(page.said.bytes == page.text.size());
    CHECK(std::filesystem::file_size(folder.path("page.html")) == page.said.bytes);
    CHECK(static_cast<double>(page.text.size()) <= 1.3 * static_cast<double>(page.said.packedBytes) + 300e3);
    for (const char c : page.text) REQUIRE((c == '\n' || (c >= 32 && c < 127)));
    // Nothing is loaded: no address of anything but what stands in the file.
    for (const char* foreign : {"http:", "https:", "//cdn", "@import", "url("})
        CHECK(page.text.substr(0, page.text.find("id=\"voxels\"")).find(foreign) == std::string::npos);
    CHECK(page.text.find("default-src 'none'") != std::string::npos);
}

TEST_CASE("a title is text wherever it stands", "[share]") {
    const TempFolder folder;
    ShareSettings settings;
    settings.density = ShareDensity::Off;
    const std::size_t scripts = timesIn(pageOf(taskOf(sampleScene(), folder, settings)).text, "<script");
    settings.title = "</script><script>x()</script><img src=x onerror=y()>{{voxels}}\xe2\x80\xa8";
    const Page page = pageOf(taskOf(sampleScene(), folder, settings));
    CHECK(timesIn(page.text, "<script") == scripts);
    CHECK(page.text.find("x()</script>") == std::string::npos);
    CHECK(page.text.find("<img src=x") == std::string::npos);
    CHECK(page.between("<title>", "</title>").starts_with("&#60;/script&#62;&#60;script&#62;x()"));
    CHECK(page.scene["title"].get<std::string>().starts_with("</script><script>x()</script>"));
    CHECK(!page.scene.contains("density"));
    CHECK(page.text.find('\xe2') == std::string::npos);
}

TEST_CASE("names of DICOM data stay out of a page", "[share]") {
    Scene scene = sampleScene();
    auto named = std::make_shared<Volume>(*scene.data);
    named->title = "/data/skull.2.nrrd";
    named->format = "NRRD";
    scene.data = named;
    CHECK(proposedTitle(scene) == "skull");
    auto dicom = std::make_shared<Volume>(*named);
    dicom->title = "MUELLER^HANNELORE";
    dicom->format = "DICOM";
    dicom->notices = {"series of MUELLER^HANNELORE"};
    scene.data = dicom;
    scene.volume = dicom;
    CHECK(proposedTitle(scene) == "Volume");
    const TempFolder folder;
    ShareSettings settings;
    settings.density = ShareDensity::Off;
    const std::string text = pageOf(taskOf(scene, folder, settings)).text;
    for (const char* part : {"MUELLER", "HANNELORE"})
        CHECK(text.find(part) == std::string::npos); // too long to occur by chance
}

TEST_CASE("a page is made coarser to the size that is named, and says so", "[share]") {
    const TempFolder folder;
    const Scene scene = sampleScene("tents:3", 32);
    ShareSettings settings;
    settings.density = ShareDensity::Off;
    settings.voxels = 5000; // 16³ = 4096 fit, 32³ do not
    const Page page = pageOf(taskOf(scene, folder, settings));
    CHECK(page.said.factor == 2);
    CHECK(page.said.dims == Int3(16));
    CHECK(page.scene["volume"]["dims"] == json({16, 16, 16}));
    CHECK(page.scene["volume"]["full_dims"] == json({32, 32, 32}));
    CHECK(page.between("<p id=\"size\">", "</p>") ==
          "16 &times; 16 &times; 16 voxels, made coarser: each is the mean of up to 2 &times; 2 &times; 2 of 32 "
          "&times; 32 &times; 32");
    // Opacities keep their length: that of the fine voxels.
    CHECK(page.scene["volume"]["d0"].get<double>() == Approx(scene.volume->geometry().d0()));
    CHECK(estimateShare(scene, settings, pageBytesPerVoxel(scene, settings.bits)).dims == Int3(16));

    const Page whole = pageOf(taskOf(scene, folder, {.voxels = 32 * 32 * 32, .density = ShareDensity::Off}));
    CHECK(whole.said.factor == 1);
    CHECK(page.said.bytes < whole.said.bytes);
    settings.voxels = 1'000'000;
    settings.megabytes = static_cast<double>(whole.said.bytes - 1) / 1e6;
    CHECK(pageOf(taskOf(scene, folder, settings)).said.factor > 1);
    settings.megabytes = 0.01;
    CHECK_THROWS_WITH(makeShare(taskOf(scene, folder, settings)), Catch::Contains("no page is as small"));
}

TEST_CASE("clip planes mean the same among coarser voxels", "[share]") {
    const TempFolder folder;
    Scene scene = sampleScene("tents:3", 32);
    const Geometry& whole = scene.volume->geometry();
    // Through the centre of voxel (10, 10, 10), and a box whose fractions meet voxel borders.
    const Vec3 normal(1, 2, 2), place = whole.worldFromVoxel(Vec3(10));
    scene.session.clipping.edit([&](Clipping& c) {
        c.planes = {{normal, normal.x * place.x + normal.y * place.y + normal.z * place.z}};
        c.lo = Vec3(0.25, 0, 0);
    });
    ShareSettings settings;
    settings.density = ShareDensity::Off;
    settings.voxels = 5000;
    const json clip = pageOf(taskOf(scene, folder, settings)).scene["view"]["clip"];
    const auto plane = clip["planes"][0].get<std::vector<double>>();
    // Voxel v of the coarser volume has its centre at 2v + 1/2 of the fine one: 10 is 4.75 there.
    const double at = (10 - 0.5) / 2;
    CHECK(plane[0] * at + plane[1] * at + plane[2] * at == Approx(plane[3]));
    CHECK(clip["lo"] == json({0.25, 0, 0})); // 2 divides 32: the box is the same
}

TEST_CASE("what a page cannot show is refused, or said", "[share]") {
    const TempFolder folder;
    const Scene scene = sampleScene();
    ShareTask task = taskOf(scene, folder);
    task.look.mode = RenderMode::Mip;
    CHECK_THROWS_WITH(checkShare(task), Catch::Contains("emission and absorption"));
    task = taskOf(scene, folder);
    task.look.background.reset();
    CHECK_THROWS_AS(checkShare(task), UsageError);
    task = taskOf(scene, folder);
    task.scene.session.field.edit([](FieldView& f) { f.kind = FieldKind::Visibility; });
    CHECK_THROWS_WITH(checkShare(task), Catch::Contains("field"));

    task = taskOf(scene, folder, {.density = ShareDensity::Off});
    task.look.light.occlusion = 0.5;
    const Page page = pageOf(task);
    REQUIRE(page.said.leftOut.size() == 1);
    CHECK(page.said.leftOut[0].find("ambient occlusion") == 0);
    CHECK(page.scene["openness"]["dims"] == json({4, 4, 4})); // a cell for 4³ voxels
}

TEST_CASE("a page that is stopped leaves what was there", "[share]") {
    const TempFolder folder;
    writeTextAtomically(folder.path("page.html"), "before");
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(makeShare(taskOf(sampleScene(), folder), {stop.get_token(), {}}), Cancelled);
    CHECK(readText(folder.path("page.html")) == "before");
}
