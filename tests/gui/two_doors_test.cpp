// The window and the command line are two doors to the same room: the same inputs give the same picture and figures.
#include "gui_support.h"

#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include <QProcess>
#include <QSignalSpy>
#include <QTemporaryDir>

#include "image_io/image_file.h"
#include "session/session_json.h"
#include "tf/formats/tf_json.h"

using namespace pellucid;
using namespace pellucid::gui;
using nlohmann::json;

namespace {

constexpr double kSame = 1e-9;

/// What both doors are given.
struct Inputs {
    QString volume;
    std::optional<RawLayout> raw;
    QString rawText;
    QString tf;                      ///< empty: none is named
    std::optional<ValueRange> range; ///< of the command line's --range
    int sampleSize = 0;              ///< 0: the sample's own
};

json cli(const QStringList& arguments) {
    QProcess process;
    process.start(PELLUCID_CLI_PROGRAM, arguments + QStringList{"--json"});
    REQUIRE(process.waitForFinished(kPatience));
    INFO(arguments.join(' ').toStdString() << ": " << process.readAllStandardError().toStdString());
    REQUIRE(process.exitCode() == 0);
    return json::parse(process.readAllStandardOutput().toStdString());
}

void checkSame(const std::vector<double>& a, const std::vector<double>& b) {
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) CHECK(std::abs(a[i] - b[i]) <= kSame);
}

void checkSameTf(const TransferFunction& window, const json& written) {
    const TransferFunction line = tfFromJson(written, "stdout");
    REQUIRE(window.points.size() == line.points.size());
    for (std::size_t i = 0; i < line.points.size(); ++i) {
        CHECK(std::abs(window.points[i].x - line.points[i].x) <= kSame);
        CHECK(std::abs(window.points[i].opacity - line.points[i].opacity) <= kSame);
    }
    CHECK(window.range == line.range);
}

/// Opens the inputs in the window and compares every figure and the picture with what pellucid-cli makes of them; then
/// the same with a session that the window saved.
void compareDoors(OpenWindow& w, const Inputs& inputs) {
    const QTemporaryDir folder;
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    VolumeSource source;
    source.path = inputs.volume.toStdString();
    source.raw = inputs.raw;
    source.range = inputs.range;
    source.sampleSize = inputs.sampleSize;
    w.opening().openVolume(source, inputs.tf);
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    w.settle();

    QStringList named{inputs.volume};
    if (!inputs.rawText.isEmpty()) named << "--raw" << inputs.rawText;
    if (!inputs.tf.isEmpty()) named << "--tf" << inputs.tf;
    if (inputs.sampleSize > 0) named << "--sample-size" << QString::number(inputs.sampleSize);
    if (inputs.range)
        named << "--range"
              << QStringLiteral("%1,%2").arg(inputs.range->lo, 0, 'g', 17).arg(inputs.range->hi, 0, 'g', 17);
    w.services().store().edit("Refinement", {}, [](Session& s) {
        s.refine.edit([](RefineSettings& r) {
            r.method = RefineMethod::Exact;
            r.intensity = 0.4;
        });
    });
    const QString session = folder.filePath("s.pellucid.json");
    const Session before = w.services().store().session();
    REQUIRE(w.saving().saveSession(session));

    for (const QStringList& door : {named, QStringList{"--session", session}}) {
        INFO(door.join(' ').toStdString());
        const Measures& m = *w.document().measures();
        const json measured = cli(QStringList{"measure"} + door);
        REQUIRE(measured["features"].size() == m.features.size());
        for (std::size_t f = 0; f < m.features.size(); ++f) {
            const json& line = measured["features"][f];
            checkSame(
                {m.features[f].visibility, m.features[f].vws, m.features[f].vwsBrightness, m.features[f].vwsSaturation,
                 m.opacities[f]},
                {line["visibility"], line["vws"], line["vws_brightness"], line["vws_saturation"], line["opacity"]});
        }
        checkSame(m.visibilityHistogram, measured["visibility_histogram"].get<std::vector<double>>());
        checkSame({w.document().volume()->range().lo, w.document().volume()->range().hi},
                  measured["volume"]["range"].get<std::vector<double>>());

        // The picture, pixel by pixel.
        const QString ours = folder.filePath("window.png"), theirs = folder.filePath("line.png");
        w.saving().saveImage({ours, {160, 120}, false, true});
        w.settle();
        const QStringList light = door == named ? QStringList{"--shading"} : QStringList(); // as volumes open here
        cli(QStringList{"render"} + door + light +
            QStringList{"--size", "160x120", "--annotate", "cube,letters,scale", "--out", theirs});
        CHECK(readImage(ours.toStdString()).rgba == readImage(theirs.toStdString()).rgba);

        const QStringList how = door == named ? QStringList{"--method", "exact", "--intensity", "0.4"} : QStringList();
        const json refined = cli(QStringList{"refine"} + door + how);
        const TransferFunction unrefined = w.document().tf();
        w.refining().refine();
        checkSameTf(w.document().tf(), refined["tf"]);
        if (!(w.document().tf() == unrefined)) w.document().undo();

        const std::size_t features = m.features.size();
        if (features < 2) continue;
        QStringList targets;
        std::vector<double> wanted;
        for (std::size_t f = 0; f < features; ++f) {
            targets << QString::number(f + 1);
            wanted.push_back(static_cast<double>(f + 1));
        }
        double sum = 0;
        for (const double t : wanted) sum += t;
        for (double& t : wanted) t /= sum;
        const json optimized = cli(QStringList{"optimize"} + door + QStringList{"--target", targets.join(',')});
        w.document().setTargets(wanted);
        w.optimizing().start();
        REQUIRE(waitFor([&] { return !w.optimizing().isRunning(); }));
        checkSameTf(w.document().tf(), optimized["tf"]);
        const Run& run = w.services().store().session().runs->back();
        REQUIRE(run.history.size() == optimized["objective"].size());
        for (std::size_t i = 0; i < run.history.size(); ++i) {
            CHECK(std::abs(run.history[i].objective - optimized["objective"][i].get<double>()) <= kSame);
            checkSame(run.history[i].vws, optimized["vws"][i].get<std::vector<double>>());
        }
        if (!(w.document().tf() == unrefined)) w.document().undo(); // a run that finds nothing to change is no step
        if (!(w.services().store().session().goals == before.goals)) w.document().undo();
        CHECK(w.services().store().session().goals == before.goals);
        CHECK(w.document().tf() == unrefined);
        w.settle();
    }
}

QString writtenTf(const QTemporaryDir& folder, const char* name, const TransferFunction& tf) {
    const QString path = folder.filePath(name);
    writeTf(tf, path.toStdString());
    return path;
}

} // namespace

TEST_CASE("samples are the same through both doors", "[doors]") {
    OpenWindow w;
    for (const SampleInfo& sample : samples()) {
        if (sample.name.find('/') != std::string::npos) continue; // variables of one that is looked at
        // Doors are as wide for small ones, which take less time.
        const bool large = voxelCount(sample.defaultDims) > 48u * 48 * 48;
        compareDoors(w, {"sample:" + QString::fromStdString(sample.name), {}, {}, {}, {}, large ? 48 : 0});
    }
}

TEST_CASE("transfer functions with a range, without one, and a window of one's own are the same through both doors",
          "[doors]") {
    const QTemporaryDir folder;
    OpenWindow w;
    const QString sample = "sample:shells";
    constexpr int kSize = 32;
    TransferFunction plain = tents(4, 0.2), narrow = tents(2, 0.3), wide = tents(3, 0.15), bare = ramp(5);
    plain.points[1].color = {0.1234567, 0.5, 0.9}; // eight bits do not hold it
    narrow.range = ValueRange{60, 190};
    wide.range = ValueRange{-400, 900};
    bare.features = {{"low", 0.1, 0.45, {1, 0, 0}, {}}, {"high", 0.5, 0.9, {0, 0, 1}, {}}};
    const QString noRange = writtenTf(folder, "plain.tf.json", plain), inside = writtenTf(folder, "n.tf.json", narrow),
                  beyond = writtenTf(folder, "w.tf.json", wide), features = writtenTf(folder, "f.tf.json", bare);
    compareDoors(w, {sample, {}, {}, noRange, {}, kSize});
    compareDoors(w, {sample, {}, {}, inside, {}, kSize});
    compareDoors(w, {sample, {}, {}, beyond, {}, kSize});
    compareDoors(w, {sample, {}, {}, features, {}, kSize});
    compareDoors(w, {sample, {}, {}, inside, ValueRange{20.5, 230.25}, kSize});
    compareDoors(w, {sample, {}, {}, "tents:5", ValueRange{50, 200}, kSize});
}

TEST_CASE("real volumes are the same through both doors", "[doors]") {
    const std::filesystem::path real = std::filesystem::path(PELLUCID_SHARED_DIR) / "data" / "real";
    if (!std::filesystem::exists(real)) {
        WARN("SKIPPED: no real volumes here");
        return;
    }
    const QTemporaryDir folder;
    OpenWindow w;
    const auto path = [&](const char* name) { return QString::fromStdString((real / name).string()); };
    compareDoors(w, {path("nucleon/nucleon.raw"), parseRawLayout("41,41,41,u8"), "41,41,41,u8", {}, {}});
    compareDoors(w, {path("tooth/tooth.mhd"), {}, {}, "tents:3:0.1", {}});
    const QString ct = path("cranium_ct/cranium_ct.nrrd");
    TransferFunction bone = tents(1, 0.4);
    bone.range = ValueRange{200, 2900};
    compareDoors(w, {ct, {}, {}, writtenTf(folder, "bone.tf.json", bone), {}});
    compareDoors(w, {ct, {}, {}, "tents:2:0.05", ValueRange{-200, 1500}});
}
