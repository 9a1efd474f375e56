#include <catch2/catch.hpp>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

#include "base/base64.h"
#include "base/error.h"
#include "image_io/image_file.h"
#include "render/feature_pictures.h"
#include "render/ssim.h"
#include "report/html_report.h"
#include "report/page_parts.h"
#include "report/report.h"
#include "run_support.h"
#include "session/caption.h"
#include "session/session_json.h"
#include "support/temp_folder.h"
#include "support/text_parts.h"
#include "tf/shown_tf.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

Report smallReport(const std::string& hostile = "skin") {
    Report report;
    report.run = exampleRun();
    report.title = hostile;
    report.run.features[0] = hostile;
    report.run.start.edit([&](RunStart& start) { start.tf.features[0].name = hostile; });
    const std::vector<unsigned char> png = pngOf(Image(4, 3));
    report.before = report.after = {4, 3, png};
    report.tfBefore = report.tfAfter = report.run.start->tf;
    report.window = {0, 255};
    report.unit = hostile;
    report.measuresBefore = report.measuresAfter = {{0.4, 0.8, 0.8, 0.8}, {0.6, 0.2, 0.2, 0.2}};
    report.states = {{0, 0.5, {4, 3, png}}, {1, 0.9, {4, 3, png}}, {2, 1, {4, 3, png}}};
    report.settings = {{"Volume", hostile}};
    report.remarks = {hostile};
    report.captionBefore = report.altAfter = hostile;
    report.command = "pellucid-cli optimize '" + hostile + "'";
    report.program = "Pellucid";
    return report;
}

std::string textOf(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

/// The shells with three tents, and a run of three states on them.
struct Case {
    Scene scene;
    Run run;

    Case() {
        VolumeSource source;
        source.path = "sample:shells";
        source.sampleSize = 20;
        SceneInputs inputs;
        inputs.session = sessionOf(source);
        inputs.tf = "tents:3";
        scene = openScene(inputs);
        OptimizeResult result;
        result.targets = {0.2, 0.3, 0.5};
        result.history = {{0.4, {0.6, 0.3, 0.1}, {0.5, 0.5, 0.5}, 0},
                          {0.02, {0.21, 0.3, 0.49}, {0.1, 0.3, 0.6}, 1},
                          {0.001, {0.2, 0.3, 0.5}, {0.09, 0.31, 0.62}, 0}};
        result.best = 2;
        result.reason = StopReason::Converged;
        run = runOf(result, runStartOf(scene, {}));
    }
};

} // namespace

TEST_CASE("base64 of RFC 4648", "[report]") {
    // Its test vectors, section 10.
    const std::pair<std::string, std::string> vectors[] = {{"", ""},
                                                           {"f", "Zg=="},
                                                           {"fo", "Zm8="},
                                                           {"foo", "Zm9v"},
                                                           {"foob", "Zm9vYg=="},
                                                           {"fooba", "Zm9vYmE="},
                                                           {"foobar", "Zm9vYmFy"}};
    for (const auto& [plain, encoded] : vectors)
        CHECK(base64({reinterpret_cast<const unsigned char*>(plain.data()), plain.size()}) == encoded);
}

TEST_CASE("a report fetches nothing", "[report]") {
    const std::string html = htmlOf(smallReport());
    static const std::regex source(R"re((?:src|href|srcset|data|action)\s*=\s*"([^"]*)")re");
    std::size_t count = 0;
    for (std::sregex_iterator it(html.begin(), html.end(), source), end; it != end; ++it, ++count)
        CHECK((*it)[1].str().rfind("data:", 0) == 0);
    CHECK(count == 6); // before, after, three states, the table
    for (const char* word : {"<script", "<link", "<iframe", "@import", "url("}) {
        INFO(word);
        CHECK(html.find(word) == std::string::npos);
    }
    // The only addresses are names of XML.
    CHECK(timesIn(html, "http") == timesIn(html, "http://www.w3.org/2000/svg"));
}

TEST_CASE("no text of a report is taken for markup", "[report]") {
    const std::string hostile = "\"'><img src=x onerror=alert(1)><script>&";
    const std::string html = htmlOf(smallReport(hostile));
    CHECK(html.find("<script") == std::string::npos);
    CHECK(html.find("<img src=x") == std::string::npos);
    CHECK(html.find(hostile) == std::string::npos);
    // Title twice, table, setting, remark, command, and the legends of curves and bars.
    CHECK(timesIn(html, "&quot;&#39;&gt;&lt;img src=x onerror=alert(1)&gt;&lt;script&gt;&amp;") >= 6);
}

TEST_CASE("the threshold of §5.4 is checked on the states that lie below it", "[report]") {
    Run run = exampleRun(); // F 0.4, 0.1, 0.02; the answer is the last
    std::vector<ReportState> states{{0, 0.5, {}}, {1, 0.995, {}}, {2, 1, {}}};
    // Only the answer is below 0.03.
    CHECK(thresholdCheck(run, states).below == 0);
    CHECK(wordsOf(thresholdCheck(run, states)).find("says nothing") != std::string::npos);
    run.history[1].objective = 0.029;
    CHECK(thresholdCheck(run, states).below == 1);
    CHECK(thresholdCheck(run, states).holds());
    CHECK(
        wordsOf(thresholdCheck(run, states)) ==
        "One state beside the answer has F below 0.03, and each looks like it: SSIM above 0.99, as §5.4 found (lowest: "
        "SSIM 0.9950 at move 1).");
    states[1].ssim = 0.98;
    CHECK_FALSE(thresholdCheck(run, states).holds());
    CHECK(thresholdCheck(run, states).worst == 1);
    CHECK(wordsOf(thresholdCheck(run, states)).find("does not hold here") != std::string::npos);
}

TEST_CASE("pictures of a long run are evenly chosen", "[report]") {
    Run run;
    run.history.resize(1001);
    run.best = 777;
    const auto chosen = chosenStates(run, 12);
    // Eleven of them 100 moves apart, and the answer.
    CHECK(chosen == std::vector<std::size_t>{0, 100, 200, 300, 400, 500, 600, 700, 777, 800, 900, 1000});
    run.history.resize(5);
    run.best = 2;
    CHECK(chosenStates(run, 12) == std::vector<std::size_t>{0, 1, 2, 3, 4});
}

TEST_CASE("a report shows what its run began with and came to", "[report]") {
    const Case c;
    Workspace workspace;
    ReportRequest request{.run = c.run, .scene = sceneAtStart(c.run, c.scene)};
    request.width = 64;
    request.height = 48;
    const Report report = makeReport(request, workspace);
    CHECK(featureOpacities(report.tfBefore) == c.run.history[0].opacity);
    CHECK(report.before.width == 64);
    CHECK(report.before.height == 48);
    REQUIRE(report.states.size() == 3);
    // The answer is equal to itself; a state near it looks more like it than the start does.
    CHECK(report.states[2].ssim == Approx(1));
    CHECK(report.states[1].ssim > report.states[0].ssim);
    CHECK(report.states[1].ssim < 1);
    // Visibilities are measured, of both ends.
    REQUIRE(report.measuresAfter.size() == 3);
    CHECK(report.measuresAfter[2].visibility > report.measuresBefore[2].visibility);

    // So is what of both pictures catches the eye.
    const PictureInput p = pictureInput(sceneAtStart(c.run, c.scene), 64, 48);
    const auto renderer = makeCpuRenderer(p.volume);
    CHECK(report.fsBefore.size() == 3);
    for (std::size_t f = 0; f < 3; ++f)
        CHECK(report.fsBefore[f] ==
              Approx(featureSaliency(featurePictures(*renderer, p.camera, p.tf, p.settings)).shares[f]).margin(0.01));
    CHECK(report.fsAfter[2] > report.fsBefore[2]);

    // Both pictures are put into words, of their own shares.
    const Scene before = sceneAtStart(c.run, c.scene);
    const CaptionFacts facts = captionFacts(before, workspace.measure(measureInput(before)));
    CHECK(report.captionBefore == caption(facts));
    CHECK(report.altBefore == altText(facts));
    CHECK(report.captionAfter != report.captionBefore);
    const std::string html = htmlOf(report);
    CHECK(html.find("<figcaption>" + report.captionAfter + "</figcaption>") != std::string::npos);
    CHECK(html.find("alt=\"Before: " + report.altBefore + "\"") != std::string::npos);

    SECTION("the SSIM is that of the pictures") {
        const TempFolder folder;
        std::vector<Image> images;
        for (const ReportPicture* end : {&report.before, &report.after}) {
            const std::string file = folder.path("picture.png");
            std::ofstream(file, std::ios::binary)
                .write(reinterpret_cast<const char*>(end->png.data()), static_cast<std::streamsize>(end->png.size()));
            images.push_back(readImage(file));
        }
        // PNG has 8 bits: half a step of 1/255 in each pixel.
        CHECK(ssim(images[0], images[1]) == Approx(report.states[0].ssim).margin(0.005));
    }
    SECTION("it is cancelled between pictures") {
        std::stop_source stop;
        JobControl job{stop.get_token(), [&](double fraction) {
                           if (fraction > 0.5) stop.request_stop();
                       }};
        CHECK_THROWS_AS(makeReport(request, workspace, job), Cancelled);
    }
}

TEST_CASE("the session of a report's start repeats the run", "[report]") {
    Case c;
    c.run.start.edit([](RunStart& start) {
        start.limits = {{0, 1, true}, {0.2, 0.6, false}, {0, 1, false}};
        start.options.maxIterations = 17;
        start.measure.saliency.sigma = 3;
    });
    // Meanwhile everything has changed.
    Scene now = c.scene;
    now.session.setTf(withFeatureOpacities(now.tf, {0.01, 0.02, 0.03}));
    now.session.camera = cameraFromView(now.volume->geometry(), 70, 40, 2, Projection::Orthographic);
    const Session session = sessionAtStart(c.run, now.session);
    const Scene scene = resolve(session, now);
    CHECK(featureOpacities(scene.tf) == featureOpacities(c.scene.tf));
    CHECK(scene.camera == c.scene.camera);
    CHECK(scene.targets() == std::vector<double>{0.2, 0.3, 0.5});
    CHECK(limitsOf(scene.tf, *session.goals) == c.run.start->limits);
    CHECK(session.optimize->maxIterations == 17);
    CHECK(session.measure->saliency.sigma == 3);
    CHECK(session.runs->empty());
}

TEST_CASE("a report is written whole, into a folder old or new", "[report]") {
    const TempFolder folder;
    Report report = smallReport();
    const std::filesystem::path target = folder.path("new/deep");
    writeReport(report, target.string());
    CHECK(textOf(target / kReportFile) == htmlOf(report));
    CHECK(textOf(target / kCurvesFile).rfind("run,method,move", 0) == 0);
    CHECK_FALSE(std::filesystem::exists(target / kStartFile));
    report.title = "another";
    report.session = Case().scene.session;
    writeReport(report, target.string());
    CHECK(textOf(target / kReportFile).find("another") != std::string::npos);
    CHECK(readSession((target / kStartFile).string()).session.variable().source.path == "sample:shells");
    CHECK(std::distance(std::filesystem::directory_iterator(target), std::filesystem::directory_iterator()) == 3);

    const std::string file = folder.write("file", "in the way");
    CHECK_THROWS_AS(writeReport(report, file), FileError);
    CHECK(textOf(file) == "in the way");
}
