// Optimization over time and from different starts (sections 5.4.1 and 5.4.2): figures 5.12 to 5.17.
#include <algorithm>
#include <cmath>

#include "base/round_numbers.h"
#include "base/text.h"
#include "report/convergence.h"
#include "reproduce/search_cases.h"

namespace pellucid::cli {

namespace {

const DataNeed kVortexSeries{"vortex (128×128×128, 100 time steps)", "vortex"};

// ---- Over time ----------------------------------------------------------------------------------------------------

constexpr int kEvery = 5; ///< time steps from frame to frame: 0, 5, …, 95
constexpr const char* kFrames = "0:95:5";

/// A figure of each feature in each frame.
using Curves = std::vector<std::vector<double>>;

Curves curvesOf(const Json& sequence, const std::string& key, bool asStatic) {
    Curves curves;
    for (const Json& frame : sequence.at("frames")) curves.push_back((asStatic ? frame.at("static") : frame).at(key));
    return curves;
}

Plot plotOf(const std::string& title, const Curves& curves, const TransferFunction& tf, double highest) {
    Plot plot{
        .title = title,
        .x = {.label = "time step", .lo = 0, .hi = static_cast<double>(kEvery * (curves.size() - 1)), .whole = true},
        .y = {.label = "share", .lo = 0, .hi = highest},
        .series = {}};
    for (std::size_t f = 0; f < tf.features.size(); ++f) {
        PlotSeries series{.name = tf.features[f].name, .color = tf.features[f].color, .points = {}};
        for (std::size_t i = 0; i < curves.size(); ++i)
            series.points.push_back({static_cast<double>(kEvery) * static_cast<double>(i), curves[i].at(f)});
        plot.series.push_back(std::move(series));
    }
    return plot;
}

/// How often two curves change places.
int crossingsOf(const Curves& curves) {
    int crossings = 0;
    for (std::size_t i = 1; i < curves.size(); ++i)
        for (std::size_t a = 0; a < curves[i].size(); ++a)
            for (std::size_t b = a + 1; b < curves[i].size(); ++b)
                crossings += (curves[i - 1][a] - curves[i - 1][b]) * (curves[i][a] - curves[i][b]) < 0;
    return crossings;
}

/// How far curves go from frame to frame, on average.
double changeOf(const Curves& curves) {
    double sum = 0;
    for (std::size_t i = 1; i < curves.size(); ++i)
        for (std::size_t f = 0; f < curves[i].size(); ++f) sum += std::abs(curves[i][f] - curves[i - 1][f]);
    return sum / static_cast<double>((curves.size() - 1) * curves.front().size());
}

/// From the lowest to the highest of one feature.
double rangeOf(const Curves& curves, std::size_t feature) {
    const auto [least, most] =
        std::ranges::minmax(curves, {}, [&](const std::vector<double>& frame) { return frame.at(feature); });
    return most[feature] - least[feature];
}

std::string pictureFile(int timeStep, const std::string& suffix) {
    std::string number = std::to_string(timeStep / kEvery);
    number.insert(0, 4 - number.size(), '0');
    return "frames/frame_" + number + suffix;
}

void overTime(Desk& desk) {
    const Source vortex = desk.sample("vortex", std::min(48, desk.settings().sampleSize), kVortexSeries.thesis);
    const TransferFunction tf = threeTents({0.2, 0.2, 0.2}, searchCases()[3].colors);
    const std::string start = desk.writeTf("start", tf);
    const Json series =
        desk.ask("sequence", Words{"sequence"} + vortex.words +
                                 Words{"--frames", kFrames, "--tf", start, "--mode", "optimize", "--target", "equal",
                                       "--exact-shares", "--coherence", "0", "--compare", "--2dfs", "--view", "30,20",
                                       "--size", "320x320", "--out", desk.file("frames")});
    const Curves still = curvesOf(series, "vws", true), following = curvesOf(series, "vws", false),
                 stillFs = curvesOf(series, "fs", true), followingFs = curvesOf(series, "fs", false);
    double highest = 0;
    for (const Curves* curves : {&still, &following})
        for (const std::vector<double>& frame : *curves) highest = std::max(highest, *std::ranges::max_element(frame));
    highest = std::min(1.0, 1.1 * highest);
    drawPlot(desk, "static_vws.svg", "5.12 (a)", "VWS under the transfer function of the first time step",
             plotOf("VWS, static", still, tf, highest));
    drawPlot(desk, "static_2dfs.svg", "5.12 (b)", "2D feature saliency under it",
             plotOf("2DFS, static", stillFs, tf, 1));
    drawPlot(desk, "dynamic_vws.svg", "5.13 (a)", "VWS under a transfer function optimized for each time step",
             plotOf("VWS, dynamic", following, tf, highest));
    drawPlot(desk, "dynamic_2dfs.svg", "5.13 (b)", "2D feature saliency under these",
             plotOf("2DFS, dynamic", followingFs, tf, 1));
    for (const auto& [step, part] : {std::pair{30, "(a)"}, {80, "(b)"}}) {
        const std::string at = ", time step " + std::to_string(step);
        desk.picture(desk.file(pictureFile(step, "_static.png")), std::string("5.14 ") + part, "static" + at);
        desk.picture(desk.file(pictureFile(step, ".png")), std::string("5.15 ") + part, "dynamic" + at);
    }

    const double rmsStill = series.at("static").at("rms"), rms = series.at("mean").at("rms");
    desk.statement("5.4.1", "The VWS curves of the dynamic transfer function are more converged.", rms < rmsStill,
                   "RMS of F over the frames " + figureText(rmsStill) + " static, " + figureText(rms) + " dynamic");
    desk.statement("5.4.1", "There are more small changes in the 2DFS curves of the static one.",
                   changeOf(stillFs) > changeOf(followingFs),
                   "from frame to frame " + figureText(changeOf(stillFs)) + " static, " +
                       figureText(changeOf(followingFs)) + " dynamic");
    desk.statement("5.4.1", "The three 2DFS curves cross each other more often with the static one.",
                   crossingsOf(stillFs) > crossingsOf(followingFs),
                   std::to_string(crossingsOf(stillFs)) + " crossings static, " +
                       std::to_string(crossingsOf(followingFs)) + " dynamic",
                   "In the sample the features keep their order in almost every frame, so the curves hardly cross.");
    desk.statement("5.4.1", "The dynamic one maintains a similar level of visual saliency for the purple feature.",
                   rangeOf(following, 0) < rangeOf(still, 0),
                   "its VWS varies by " + figureText(rangeOf(still, 0)) + " static, by " +
                       figureText(rangeOf(following, 0)) + " dynamic");
    desk.remark("Every fifth time step is shown. The thesis's sentence on crossings names figure 5.12 (b) on both "
                "sides; it is taken to mean that the static curves cross more often than the dynamic ones.");
}

// ---- Two starts ---------------------------------------------------------------------------------------------------

struct Answered {
    std::string tf, picture;
    double objective = 0;
    int moves = 0;
    std::vector<double> opacity;
};

/// From a start to targets, and how it looks.
Answered answerOf(Desk& desk, const Words& volume, const std::string& name, const std::string& start,
                  const std::string& targets, const Words& more, const std::string& size) {
    Answered answer{desk.file(name + ".tf.json"), desk.file(name + ".png"), 0, 0, {}};
    const Json found = desk.ask(name, Words{"optimize"} + volume +
                                          Words{"--tf", start, "--target", targets, "--out-tf", answer.tf} + more);
    answer.objective = found.at("objective").back();
    answer.moves = found.at("iterations");
    answer.opacity = found.at("opacity").back().get<std::vector<double>>();
    desk.run(Words{"render"} + volume + Words{"--tf", answer.tf, "--size", size, "--out", answer.picture});
    return answer;
}

struct Likeness {
    double ssim = 0, deltaE = 0;
};

Likeness likenessOf(Desk& desk, const std::string& name, const std::string& a, const std::string& b) {
    const Json compared = desk.ask(name, {"compare", a, b});
    return {compared.at("ssim"), compared.at("delta_e").at("mean")};
}

std::string textOf(const Likeness& alike) {
    return "SSIM " + fixedText(alike.ssim, 4) + ", mean ΔE " + fixedText(alike.deltaE, 2);
}

double farthest(const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b.at(i)));
    return most;
}

/// A row of figure 5.16 or 5.17: picture, transfer function, bars.
void showRow(Desk& desk, const Words& volume, const std::string& tf, const std::string& name,
             const std::string& picture, const std::string& figure, const std::array<const char*, 3>& parts) {
    desk.picture(picture, figure + " " + parts[0], name);
    const std::string id = std::filesystem::path(picture).stem().string();
    const std::string curve = desk.file(id + "_tf.svg"), bars = desk.file(id + "_bars.svg");
    desk.run(Words{"plot"} + volume + Words{"--tf", tf, "--out", curve});
    desk.picture(curve, figure + " " + parts[1], "the transfer function, " + name);
    desk.ask(id + "_measured", Words{"measure"} + volume + Words{"--tf", tf, "--bars", bars});
    desk.picture(bars, figure + " " + parts[2], "feature visibility and VWS, " + name);
}

void twoStarts(Desk& desk) {
    const Words volume = desk.data().words;
    const std::array<std::string, 2> starts{desk.tf("knee_ct_bone"), desk.tf("knee_ct_bone_rising")};
    const std::array<std::string, 2> names{"equal", "rising"}, figures{"5.16", "5.17"};
    const std::array<std::string, 2> targets{"equal", "1,2,3,4,5"};
    std::array<std::array<Answered, 2>, 2> answers; // by start, target
    for (std::size_t s = 0; s < 2; ++s) {
        const std::string first = desk.file("start_" + names[s] + ".png");
        desk.run(Words{"render"} + volume + Words{"--tf", starts[s], "--size", Desk::kPictureSize, "--out", first});
        showRow(desk, volume, starts[s], "before, peaks " + names[s], first, figures[s], {"(a)", "(b)", "(c)"});
        for (std::size_t t = 0; t < 2; ++t) {
            const std::string name = names[s] + "_to_" + names[t];
            answers[s][t] = answerOf(desk, volume, name, starts[s], targets[t], {}, Desk::kPictureSize);
            showRow(desk, volume, answers[s][t].tf, "from " + names[s] + " peaks to " + names[t] + " targets",
                    answers[s][t].picture, figures[s],
                    t == 0 ? std::array{"(d)", "(e)", "(f)"} : std::array{"(g)", "(h)", "(i)"});
        }
    }
    for (std::size_t t = 0; t < 2; ++t) {
        const Likeness alike = likenessOf(desk, "alike_" + names[t], answers[0][t].picture, answers[1][t].picture);
        const double apart = farthest(answers[0][t].opacity, answers[1][t].opacity);
        desk.statement("5.4.2",
                       "The final volume rendered images are very similar in appearance (" + names[t] + " targets).",
                       alike.ssim > 0.95, textOf(alike));
        desk.statement("5.4.2", "The optimized transfer functions are slightly different (" + names[t] + " targets).",
                       apart > 0 && apart < 0.1, "no opacity differs by more than " + figureText(apart),
                       apart == 0 ? "Newton's method, the default here, ends at the same opacities from both starts."
                                  : "");
        desk.statement("5.4.2", "From either start the VWS come as near to the targets (" + names[t] + ").",
                       std::abs(answers[0][t].objective - answers[1][t].objective) < 0.005,
                       "F " + figureText(answers[0][t].objective) + " and " + figureText(answers[1][t].objective));
    }
    desk.remark("The searches use the default, Newton's method. Where exact shares would leave a feature unseen, it "
                "takes the nearest shares that do not, so F stays above 0 for the rising targets.");
}

// ---- Three to nine tents ------------------------------------------------------------------------------------------

/// So many tents whose peaks rise linearly up to `highest`.
TransferFunction risingTents(int count, double highest) {
    std::vector<double> peaks;
    for (int i = 1; i <= count; ++i) peaks.push_back(highest * i / count);
    return withFeatureOpacities(tents(count), peaks);
}

void manyTents(Desk& desk) {
    constexpr double kPeak = 0.2;
    const int size = std::min(40, desk.settings().sampleSize);
    ReproducedTable table{
        "From equal and from linearly rising peaks to equal shares",
        {"tents", "F, equal start", "moves", "F, rising start", "moves", "SSIM of the pictures", "mean ΔE"},
        {}};
    double leastAlike = 1, worst = 0;
    for (int count = 3; count <= 9; ++count) {
        const Words volume = desk.sample("knee", size, kKnee.thesis).words;
        const std::string number = std::to_string(count);
        std::array<Answered, 2> answers;
        for (std::size_t s = 0; s < 2; ++s) {
            const std::string name = (s == 0 ? "equal" : "rising") + number;
            const std::string start =
                desk.writeTf(name + "_start", s == 0 ? tents(count, kPeak) : risingTents(count, 2 * kPeak));
            answers[s] = answerOf(desk, volume, name, start, "equal", {"--exact-shares"}, "200x200");
        }
        const Likeness alike = likenessOf(desk, "alike" + number, answers[0].picture, answers[1].picture);
        table.rows.push_back({number, figureText(answers[0].objective), std::to_string(answers[0].moves),
                              figureText(answers[1].objective), std::to_string(answers[1].moves),
                              fixedText(alike.ssim, 4), fixedText(alike.deltaE, 2)});
        leastAlike = std::min(leastAlike, alike.ssim);
        worst = std::max({worst, answers[0].objective, answers[1].objective});
    }
    desk.table(std::move(table));
    desk.statement("5.4.2", "With 3 to 9 tent-shaped peaks the process is not significantly sensitive to the start.",
                   leastAlike > 0.95, "the least SSIM of the pictures of both starts is " + fixedText(leastAlike, 4));
    desk.statement("5.4.2", "Nor is the quality of its output.", worst < 0.03,
                   "the largest F of all answers is " + figureText(worst));
}

} // namespace

std::vector<Item> itemsOfSection5_4() {
    return {
        {{"5.12", "5.13", "5.14", "5.15"},
         "A series under a static and a dynamic transfer function",
         "VWS and 2D feature saliency over the time steps of the vortex, and steps 30 and 80, under a transfer "
         "function "
         "for the first step and one optimized for each.",
         {kObjective, {"A", "src/saliency/image_saliency.cpp"}},
         {kVortexSeries},
         overTime},
        {{"5.16", "5.17"},
         "Five features in the colours of CT-Bone, from two starts",
         "the CT-Knee from equal and from linearly rising peaks, optimized to equal and to linearly rising shares; the "
         "pictures from both starts are very similar.",
         {kObjective},
         {kKnee},
         twoStarts},
        {{"section-5.4.2"},
         "Three to nine tents",
         "no figure here; its text says that, as with five features, the result hardly depends on the start.",
         {kObjective},
         {kKnee},
         manyTents}};
}

} // namespace pellucid::cli
