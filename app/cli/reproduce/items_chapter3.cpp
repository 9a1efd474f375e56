// Transfer function refinement: figures 3.4 to 3.14 and table 3.2.
#include <algorithm>
#include <cmath>

#include "base/round_numbers.h"
#include "base/text.h"
#include "reproduce/desk.h"

namespace pellucid::cli {

namespace {

const DataNeed kHead{"VisMale (128×256×256)", "knee", "cranium_ct/cranium_ct.nrrd", false},
    kVortex{"turbulent vortex (128×128×128, 100 steps)", "vortex"},
    kVortexStep{"turbulent vortex (128×128×128, step 1)", "vortex", "vortex/vorts1.mhd"};
const std::string kView = "30,20";

/// `tf` in the sample's own features, so that figures tell what becomes of each tissue. Nothing else changes.
TransferFunction withTissues(const TransferFunction& tf, const TransferFunction& tissues, const ValueRange& range) {
    TransferFunction told = tf;
    told.features = tissues.features;
    for (Feature& f : told.features)
        for (double* end : {&f.a, &f.b}) {
            const double value = tissues.range->lo + *end * (tissues.range->hi - tissues.range->lo);
            *end = std::clamp((value - range.lo) / (range.hi - range.lo), 0.0, 1.0);
        }
    return told;
}

/// What the tissues of the knee show before and after.
struct Tissues {
    std::vector<FeatureFigures> before, after; ///< skin and fat, muscle, bone
};

Tissues tissuesOf(Desk& desk, const Source& knee, const std::string& before, const std::string& after) {
    const Json info = desk.ask("info", Words{"info"} + knee.words);
    const ValueRange range{info.at("range").at(0), info.at("range").at(1)};
    const TransferFunction tissues = desk.readTf(desk.tf("knee_tissues"));
    Tissues told;
    for (auto [name, file, figures] :
         {std::tuple{"before", &before, &told.before}, std::tuple{"after", &after, &told.after}}) {
        const std::string named =
            desk.writeTf(std::string(name) + "_tissues", withTissues(desk.readTf(*file), tissues, range));
        *figures = featuresOf(desk.ask(name, Words{"measure"} + knee.words + Words{"--tf", named, "--view", kView}));
    }
    return told;
}

ReproducedTable tableOf(const Tissues& tissues) {
    ReproducedTable table{"Visibility of each tissue, and how much it covers of what lies behind it",
                          {"tissue", "visibility before", "after", "cover before", "after"},
                          {}};
    for (std::size_t i = 0; i < tissues.before.size(); ++i) {
        const FeatureFigures &b = tissues.before[i], &a = tissues.after[i];
        table.rows.push_back(
            {b.name, figureText(b.visibility), figureText(a.visibility), figureText(b.cover), figureText(a.cover)});
    }
    return table;
}

/// §3.5.1 of either start.
void sayWhatIsExposed(Desk& desk, const Tissues& tissues) {
    const auto& [before, after] = tissues;
    const double fleshBefore = before[0].cover + before[1].cover, fleshAfter = after[0].cover + after[1].cover;
    desk.statement("3.5.1", "After optimization the surrounding tissues become translucent.", fleshAfter < fleshBefore,
                   "total cover of skin, fat and muscle " + fromTo(fleshBefore, fleshAfter));
    desk.statement("3.5.1", "Hence the skeleton is exposed and the knee joint is visible.",
                   after[2].visibility > before[2].visibility,
                   "visibility of the bones " + fromTo(before[2].visibility, after[2].visibility));
}

void sayHowItConverged(Desk& desk, const Json& refined) {
    const double first = refined.at("energy_movable_before"), last = refined.at("energy_movable_after");
    const int iterations = refined.at("iterations");
    desk.statement("3.5.1", "The energy function converges to a small but non-zero value.",
                   last > 0 && last < 0.1 * first,
                   "energy of the movable edges " + fromTo(first, last) + ", " + fixedText(100 * last / first, 2) +
                       " % of the start");
    desk.statement("3.4.2", "There is no further change to the resulting transfer function after 500 iterations.",
                   iterations <= 500, "stable after " + std::to_string(iterations) + " iterations");
}

/// A transfer function over the histogram.
void plotTf(Desk& desk, const std::string& name, const std::string& figure, const std::string& caption,
            const Words& words) {
    desk.run(Words{"plot"} + words + Words{"--out", desk.file(name)});
    desk.picture(desk.file(name), figure, caption);
}

/// Figures 3.4 and 3.5, or 3.6 and 3.7: before and after.
struct BeforeAfter {
    std::string tf, figureBefore, figureAfter;
};

Tissues refineKnee(Desk& desk, const BeforeAfter& of) {
    const Source knee = desk.data();
    const std::string after = desk.file("after.tf.json"), before = desk.file("before.tf.json");
    // A refinement of no iterations writes the start as a file.
    desk.run(Words{"refine"} + knee.words + Words{"--tf", of.tf, "--max-iterations", "0", "--out-tf", before});
    const Json refined = desk.ask("refined", Words{"refine"} + knee.words + Words{"--tf", of.tf, "--out-tf", after});
    for (const auto& [name, tf, figure, view, curve] : {std::tuple{"before", before, of.figureBefore, "(a)", "(b)"},
                                                        std::tuple{"after", after, of.figureAfter, "(b)", "(a)"}}) {
        const std::string when = std::string(name) + " optimization";
        desk.render(std::string(name) + ".png", figure + " " + view, when,
                    knee.words + Words{"--tf", tf, "--view", kView});
        plotTf(desk, std::string(name) + ".svg", figure + " " + curve,
               "the transfer function " + when + ", and the histogram", knee.words + Words{"--tf", tf});
    }
    Tissues tissues = tissuesOf(desk, knee, before, after);
    desk.table(tableOf(tissues));
    sayWhatIsExposed(desk, tissues);
    sayHowItConverged(desk, refined);
    return tissues;
}

void refineContinuous(Desk& desk) {
    const Tissues tissues = refineKnee(desk, {"ramp:6", "3.4", "3.5"});
    desk.statement(
        "3.5.1", "The overall context is preserved.",
        std::ranges::all_of(tissues.after, [](const FeatureFigures& f) { return f.cover >= 0.02; }),
        "each tissue still covers 0.02 of what lies behind it or more: " +
            joined(tissues.after, ", ", [](const FeatureFigures& f) { return f.name + " " + figureText(f.cover); }));
}

/// Table 3.2: the searches alone, as the thesis has timed them.
void timeSearches(Desk& desk) {
    struct Row {
        std::size_t data;
        const char *volume, *tf, *shape;
        double thesis500, thesis1000; ///< seconds
    };
    for (const Row& row : {Row{0, "CT-Knee", "tents:6", "six tents", 0.002, 0.005},
                           Row{0, "CT-Knee", "ramp:6", "the ramp", 0.005, 0.009},
                           Row{1, "VisMale", "tents:6", "six tents", 0.002, 0.005},
                           Row{1, "VisMale", "ramp:6", "the ramp", 0.005, 0.008}}) {
        const Source source = desk.data(row.data);
        const std::string name =
            std::string(row.data == 0 ? "knee" : "head") + "_" + (row.tf[0] == 'r' ? "ramp" : "tents");
        const Json bench =
            desk.ask(name, Words{"bench"} + source.words +
                               Words{"--tf", row.tf, "--only", "refine-500,refine-1000", "--threads", "1"});
        const double faster = bench.at("rows").at(0).at("seconds"), longer = bench.at("rows").at(1).at("seconds");
        const std::string of = std::string(row.volume) + ", " + row.shape;
        desk.number(of + ", 500 iterations", faster, row.thesis500, "s");
        desk.number(of + ", 1000 iterations", longer, row.thesis1000, "s");
        desk.statement("3.4.2", "The tests all finished within 0.01 seconds (" + of + ").", longer < 0.01,
                       longer < 0.01 ? "so do these" : "1000 iterations take longer here");
    }
    desk.remark("The times are those of the search for an intensity chosen on the palette, with the histogram ready. "
                "They do not depend on the size of the volume, so times on samples and substitute data can be compared "
                "with those of the thesis.");
}

/// Hues that the palette of ramp:6 gives to tissues of the sample, and their names.
struct Choice {
    const char *name, *hue;
};

/// The opacity at the chosen intensity as a part of the mean over all.
double emphasisOf(const TransferFunction& tf, double intensity) {
    constexpr int kPlaces = 256;
    double mean = 0;
    for (int i = 0; i < kPlaces; ++i) mean += tf.opacity((i + 0.5) / kPlaces) / kPlaces;
    return mean > 0 ? tf.opacity(intensity) / mean : 0;
}

void choosePalette(Desk& desk) {
    const Source knee = desk.data();
    const Words start = knee.words + Words{"--tf", "ramp:6"};
    const std::string global = desk.file("global.tf.json");
    desk.run(Words{"refine"} + start + Words{"--out-tf", global});
    char letter = 'a';
    for (const Choice& choice : {Choice{"green", "150"}, Choice{"blue", "210"}, Choice{"magenta", "330"}}) {
        const std::string name = choice.name, tf = desk.file(name + ".tf.json");
        const Json refined = desk.ask(name, Words{"refine"} + start + Words{"--hue", choice.hue, "--out-tf", tf});
        const double intensity = refined.at("priority").at("intensity");
        plotTf(desk, name + ".svg", "3.8", "optimized for " + name + ", intensity " + figureText(intensity),
               knee.words + Words{"--tf", tf, "--highest", "1"});
        desk.render(name + ".png", std::string("3.9 (") + letter++ + ")", "optimized for " + name,
                    knee.words + Words{"--tf", tf, "--view", kView});
        const double before = emphasisOf(desk.readTf(global), intensity),
                     after = emphasisOf(desk.readTf(tf), intensity);
        desk.statement("3.5.2",
                       "The transfer function is enhanced for the intensities mapped to " + name +
                           ", compared to the result of the global optimization.",
                       after > before,
                       "opacity there as a multiple of the mean " + fixedText(before, 2) + " → " + fixedText(after, 2));
    }
    desk.remark("The thesis chooses red, green and magenta on its palette. In the sample, red is air, so the colours "
                "here are those of skin and fat, of spongy bone and of dense bone.");
}

// --- A region under a clipping plane ---

/// Where the bone is seen under the plane, in pixels of the picture.
struct Cut {
    std::string clip, view, region;
    const char* outer;  ///< feature of tents:4 that lies outside
    const char* wanted; ///< the one of the bone
};

void refineRegion(Desk& desk) {
    Source head = desk.data();
    // Hounsfield units of fat to dense bone; teeth and metal would leave most of the range to themselves.
    if (head.isReal) head.words = head.words + Words{"--downsample", "2", "--range", "-700,1500"};
    const Cut cut = head.isReal ? Cut{"y:0:0.5", "0,0", "165,121,220,128", "f2", "f3"}
                                : Cut{"y:0.5:1", "0,20", "170,160,210,200", "f2", "f3"};
    const std::string global = desk.file("global.tf.json"), region = desk.file("region.tf.json");
    desk.run(Words{"refine"} + head.words + Words{"--tf", "tents:4", "--out-tf", global});
    desk.run(Words{"refine"} + head.words +
             Words{"--tf", global, "--view", cut.view, "--clip", cut.clip, "--region", cut.region, "--size",
                   Desk::kPictureSize, "--out-tf", region});
    std::vector<std::vector<FeatureFigures>> states;
    for (const auto& [name, tf, figure, caption] :
         {std::tuple{"start", std::string("tents:4"), "3.10 (a)", "preliminary view"},
          std::tuple{"global", global, "3.10 (b)", "optimized"},
          std::tuple{"region", region, "3.10 (e)", "optimized for the region"}}) {
        const Words words = head.words + Words{"--tf", tf, "--view", kView};
        desk.render(std::string(name) + ".png", figure, caption, words);
        states.push_back(featuresOf(desk.ask(name, Words{"measure"} + words)));
    }
    plotTf(desk, "start.svg", "3.10 (c)", "histogram, and the four tents", head.words + Words{"--tf", "tents:4"});
    desk.render("clipped.png", "3.10 (d)", "under the clipping plane; the region is the pixels " + cut.region,
                head.words + Words{"--tf", global, "--view", cut.view, "--clip", cut.clip});
    const auto of = [&](std::size_t state, const char* feature) {
        return *std::ranges::find(states[state], feature, &FeatureFigures::name);
    };
    desk.statement("3.5.3", "After the optimization the outside is less opaque.",
                   of(1, cut.outer).opacity < of(0, cut.outer).opacity,
                   "opacity of the flesh " + fromTo(of(0, cut.outer).opacity, of(1, cut.outer).opacity));
    desk.statement("3.5.3", "So the inner structures are revealed.",
                   of(1, cut.wanted).visibility > of(0, cut.wanted).visibility,
                   "visibility of the bone " + fromTo(of(0, cut.wanted).visibility, of(1, cut.wanted).visibility));
    desk.statement("3.5.3", "However, the intermediate material (the bone) also becomes less clear.",
                   of(1, cut.wanted).opacity < of(0, cut.wanted).opacity,
                   "opacity of the bone " + fromTo(of(0, cut.wanted).opacity, of(1, cut.wanted).opacity),
                   "Bone is rare in this head, and entropy refinement reduces only the opacity of common values.");
    desk.statement("3.5.3", "The bone becomes more clear after the region-based optimization.",
                   of(2, cut.wanted).visibility > of(1, cut.wanted).visibility,
                   "visibility of the bone " + fromTo(of(1, cut.wanted).visibility, of(2, cut.wanted).visibility));
    desk.statement("3.5.3", "The outer layer is de-emphasized.",
                   of(2, cut.outer).visibility < of(1, cut.outer).visibility,
                   "visibility of the flesh " + fromTo(of(1, cut.outer).visibility, of(2, cut.outer).visibility));
}

// --- A series ---

/// Largest change of the opacity of any control point from one transfer function to the other.
double changeBetween(const Json& a, const Json& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.at("points").size(); ++i)
        most = std::max(most, std::abs(a.at("points").at(i).at("opacity").get<double>() -
                                       b.at("points").at(i).at("opacity").get<double>()));
    return most;
}

/// Half of Σ |p(i) − q(i)|: the part of the voxels that lie in other bins.
double histogramDistance(const Json& a, const Json& b) {
    double totalA = 0, totalB = 0, distance = 0;
    for (const Json& count : a) totalA += count.get<double>();
    for (const Json& count : b) totalB += count.get<double>();
    for (std::size_t i = 0; i < a.size(); ++i)
        distance += std::abs(a.at(i).get<double>() / totalA - b.at(i).get<double>() / totalB) / 2;
    return distance;
}

constexpr int kLaterFrame = 50;

std::string frameFile(const Desk& desk, const std::string& colour, int frame) {
    return desk.file(colour + "/frame_00" + (frame < 10 ? "0" : "") + std::to_string(frame) + ".tf.json");
}

std::string globalFile(const Desk& desk, int frame) {
    return desk.file("global_" + std::to_string(frame) + ".tf.json");
}

/// Histograms with a transfer function of each colour, of one step.
Json lookAtFrame(Desk& desk, const Source& vortex, const Choice& choice, int frame, const std::string& letter) {
    const std::string number = std::to_string(frame), name = std::string(choice.name) + "_" + number;
    const Words words = vortex.words + Words{"--frame", number, "--tf", frameFile(desk, choice.name, frame)};
    desk.render(name + ".png", (frame == 0 ? "3.12 (" : "3.13 (") + letter + ")",
                "step " + number + ", optimized for " + choice.name, words + Words{"--view", kView});
    const std::string plot = desk.file(name + ".svg");
    const Json drawn = desk.ask(name, Words{"plot"} + words + Words{"--highest", "1", "--out", plot});
    desk.picture(plot, "3.14", "histogram of step " + number + ", and the transfer function for " + choice.name);
    return drawn.at("histogram");
}

/// The thesis's own data, of which one step is there.
void refineOwnStep(Desk& desk, const Choice& choice) {
    const Source step = desk.data(1);
    const std::string name = std::string(choice.name) + "_own", tf = desk.file(name + ".tf.json");
    desk.run(Words{"refine"} + step.words + Words{"--tf", "ramp:6", "--hue", choice.hue, "--out-tf", tf});
    desk.render(name + ".png", "3.12", std::string("the thesis's own step 1, optimized for ") + choice.name,
                step.words + Words{"--tf", tf, "--view", kView});
}

void refineSeries(Desk& desk) {
    const Source vortex = desk.data();
    for (const int frame : {0, kLaterFrame})
        desk.run(Words{"refine"} + vortex.words +
                 Words{"--frame", std::to_string(frame), "--tf", "ramp:6", "--out-tf", globalFile(desk, frame)});
    double mostBetweenFrames = 0;
    Json histograms = Json::array();
    std::string colours;
    char letter = 'a';
    for (const Choice& choice : {Choice{"green", "150"}, Choice{"blue", "210"}, Choice{"violet", "270"}}) {
        const Json series = desk.ask(choice.name, Words{"sequence"} + vortex.words +
                                                      Words{"--frames", "0:" + std::to_string(kLaterFrame), "--tf",
                                                            "ramp:6", "--mode", "refine", "--hue", choice.hue,
                                                            "--no-pictures", "--out", desk.file(choice.name)});
        const Json& frames = series.at("frames");
        for (std::size_t i = 1; i < frames.size(); ++i)
            mostBetweenFrames =
                std::max(mostBetweenFrames, changeBetween(frames.at(i - 1).at("tf"), frames.at(i).at("tf")));
        const double intensity = series.at("priority").at("intensity");
        colours += (colours.empty() ? "" : ", ") + std::string(choice.name) + " for intensity " + figureText(intensity);
        if (realFileOf(kVortexStep, desk.settings())) refineOwnStep(desk, choice);
        const std::string place(1, letter++);
        histograms = {lookAtFrame(desk, vortex, choice, 0, place),
                      lookAtFrame(desk, vortex, choice, kLaterFrame, place)};
        for (const int frame : {0, kLaterFrame}) {
            const double plain = emphasisOf(desk.readTf(globalFile(desk, frame)), intensity),
                         chosen = emphasisOf(desk.readTf(frameFile(desk, choice.name, frame)), intensity);
            desk.statement("3.5.4",
                           "The materials with intensity values mapped to " + std::string(choice.name) +
                               " are enhanced at step " + std::to_string(frame) +
                               ", compared to a global optimization of the step.",
                           chosen > plain, "opacity there as a multiple of the mean " + fromTo(plain, chosen));
        }
        const double change = changeBetween(frames.front().at("tf"), frames.back().at("tf"));
        desk.statement("3.5.4", "Step 50 shows similar results as step 0 (" + std::string(choice.name) + ").",
                       change < 0.25, "largest change of an opacity between the two " + figureText(change));
    }
    const double distance = histogramDistance(histograms.at(0), histograms.at(1));
    desk.statement("3.5.4", "There are only limited changes among the histograms of different time-steps.",
                   distance < 0.25,
                   fixedText(100 * distance, 1) + " % of the voxels lie in other bins at step 50 than at 0");
    desk.statement("3.5.4", "The transfer functions exhibit reasonable temporal coherency.", mostBetweenFrames < 0.1,
                   "largest change of an opacity from one step to the next " + figureText(mostBetweenFrames));
    desk.remark("The chosen colours: " + colours + " (figure 3.11).");
}

const std::vector<ReproducedEquation>& entropy() {
    static const std::vector<ReproducedEquation> kEquations{{"3.2", "src/optimize/refine/refine_edges.cpp"},
                                                            {"3.3", "src/optimize/refine/refine_edges.cpp"},
                                                            {"3.4", "src/optimize/refine/refine_edges.cpp"},
                                                            {"3.5", "src/optimize/refine/refine_edges.cpp"}};
    return kEquations;
}

const std::vector<ReproducedEquation>& chosenIntensity() {
    static const std::vector<ReproducedEquation> kEquations{{"3.6", "src/optimize/refine/refine_priority.cpp"},
                                                            {"3.7", "src/optimize/refine/refine_priority.cpp"},
                                                            {"3.8", "src/optimize/refine/refine_edges.cpp"},
                                                            {"3.9", "src/optimize/refine/refine_edges.cpp"}};
    return kEquations;
}

} // namespace

std::vector<Item> itemsOfChapter3() {
    return {
        {{"3.4", "3.5"},
         "Refinement of a continuous transfer function",
         "the CT-Knee under a ramp of equal opacities, where flesh hides the skeleton, and after the global "
         "optimization, where it is exposed.",
         entropy(),
         {kKnee},
         refineContinuous},
        {{"3.6", "3.7"},
         "Refinement of a transfer function of tents",
         "the CT-Knee under six tents of equal height, whose bottoms are fixed, and after the same optimization.",
         entropy(),
         {kKnee},
         [](Desk& desk) {
             refineKnee(desk, {"tents:6", "3.6", "3.7"});
         }},
        {{"table-3.2"},
         "Time of the optimization",
         "the seconds that 500 and 1000 iterations take for two volumes and two transfer functions.",
         entropy(),
         {kKnee, kHead},
         timeSearches,
         true},
        {{"3.8", "3.9"},
         "An intensity is chosen on the palette",
         "the CT-Knee with transfer functions optimized for three colours of the palette.",
         chosenIntensity(),
         {kKnee},
         choosePalette},
        {{"3.10"},
         "A region is chosen in the picture, under a clipping plane",
         "VisMale under four tents, after the optimization, and after one for a region on the skull that a clipping "
         "plane uncovers.",
         {{"3.10", "src/optimize/refine/region_colors.cpp"},
          {"3.11", "src/optimize/refine/refine_priority.cpp"},
          {"3.12", "src/optimize/refine/refine_priority.cpp"},
          {"3.13", "src/optimize/refine/refine_edges.cpp"},
          {"3.14", "src/optimize/refine/refine_edges.cpp"}},
         {kHead},
         refineRegion},
        {{"3.11", "3.12", "3.13", "3.14"},
         "The choice is carried over a series",
         "steps 0 and 50 of a turbulent vortex under transfer functions that were optimized for three colours, each "
         "from that of the step before, and their histograms.",
         chosenIntensity(),
         {kVortex, kVortexStep},
         refineSeries}};
}

} // namespace pellucid::cli
