// 2D feature saliency, step by step: figures A.1 to A.5.
#include <cmath>

#include "base/round_numbers.h"
#include "image_io/image_file.h"
#include "reproduce/desk.h"
#include "tf/shapes.h"

namespace pellucid::cli {

namespace {

const DataNeed kEngine{"the engine block", "knee"};
constexpr const char* kStrength = "8"; ///< as in figure A.2

/// A red feature inside a green one: the bones of the sample in its flesh.
TransferFunction redInGreen(const TransferFunction& tissues) {
    TransferFunction tf;
    tf.range = tissues.range;
    const double flesh = tissues.features[0].a, fleshEnd = tissues.features[1].b, bone = tissues.features[2].a;
    tf = withShapeAdded(tf, {ShapeKind::Trapezoid, bone, 1, 0.4, {1, 0, 0}, "red"}).tf;
    return withShapeAdded(tf, {ShapeKind::Tent, flesh, fleshEnd, 0.04, {0, 1, 0}, "green"}).tf;
}

/// The sum over the pixels of a map.
double sumOf(const Desk& desk, const std::string& name) {
    const Image map = readImage(desk.pathOf(desk.file("maps/" + name + ".exr")).string());
    double sum = 0;
    for (std::size_t i = 0; i < map.rgba.size(); i += 4) sum += static_cast<double>(map.rgba[i]);
    return sum;
}

struct Shown {
    const char *file, *figure, *caption;
};

void showMaps(Desk& desk) {
    for (const Shown& s :
         {Shown{"picture", "A.1 (a)", "P, the picture"}, Shown{"feature1", "A.1 (b)", "P1, the first feature alone"},
          Shown{"feature2", "A.1 (c)", "P2, the second one alone"}, Shown{"saliency", "A.2 (a)", "S, the saliency map"},
          Shown{"feature1_shared", "A.2 (b)", "S1, what the first feature has of it"},
          Shown{"feature2_shared", "A.2 (c)", "S2, what the second one has"}, Shown{"rest", "A.3 (a)", "S′, the rest"},
          Shown{"feature1_influence", "A.3 (b)", "Gaussian of S1"},
          Shown{"feature2_influence", "A.3 (c)", "Gaussian of S2"},
          Shown{"feature1_rest", "A.4 (a)", "S′1, the first feature's part of the rest"},
          Shown{"feature2_rest", "A.4 (b)", "S′2, the second one's"},
          Shown{"feature1_total", "A.5 (a)", "T1, all that the first feature has"},
          Shown{"feature2_total", "A.5 (b)", "T2, all that the second one has"}})
        desk.picture(desk.file("maps/" + std::string(s.file) + ".png"), s.figure, s.caption);
}

ReproducedTable figuresOf(const std::vector<FeatureFigures>& features) {
    ReproducedTable table{"2D feature saliency, with VWS and visibility", {"feature", "2DFS", "VWS", "visibility"}, {}};
    for (const FeatureFigures& f : features)
        table.rows.push_back({f.name, figureText(f.fs), figureText(f.vws), figureText(f.visibility)});
    return table;
}

void shareSaliency(Desk& desk) {
    const Source engine = desk.data();
    const std::string tf = desk.writeTf("red_in_green", redInGreen(desk.readTf(desk.tf("knee_tissues"))));
    const std::string bars = desk.file("bars.svg");
    const auto features = featuresOf(
        desk.ask("measure", Words{"measure"} + engine.words +
                                Words{"--tf", tf, "--view", "30,20,1.8", "--2dfs", "--size", "512x512", "--maps",
                                      desk.file("maps"), "--map-strength", kStrength, "--bars", bars}));
    showMaps(desk);
    desk.picture(bars, "A.5 (c)", "2D feature saliency, beside visibility and VWS");
    desk.table(figuresOf(features));

    const double all = sumOf(desk, "saliency"), rest = sumOf(desk, "rest"), first = sumOf(desk, "feature1_total"),
                 second = sumOf(desk, "feature2_total");
    desk.statement("A", "A small amount of bright pixels around the boundary remains in the residual image.",
                   rest > 0 && rest < 0.5 * all, fixedText(100 * rest / all, 1) + " % of all saliency");
    desk.statement("A",
                   "The Gaussians cover most of the bright pixels of the residual image, so that it goes to the "
                   "features.",
                   first + second > 0.95 * all, fixedText(100 * (first + second) / all, 1) + " % of S is in T1 and T2");
    const double share = first / (first + second);
    desk.statement("A", "The 2D feature saliency is a feature's part of the sum of the total maps.",
                   std::abs(features[0].fs - share) < 1e-5,
                   figureText(share) + " by the maps, " + figureText(features[0].fs) + " as measured");
    desk.remark("The maps are shown " + std::string(kStrength) +
                " times as bright as they are, as in figure A.2. The "
                "first feature is " +
                features[0].name + ", the second one " + features[1].name + ".");
}

} // namespace

std::vector<Item> itemsOfAppendixA() {
    return {{{"A.1", "A.2", "A.3", "A.4", "A.5"},
             "2D feature saliency, step by step",
             "an engine block with a red and a green feature: each alone, the saliency map, the part of it that each "
             "feature has, the residual, its Gaussians, and the 2D feature saliency.",
             {{"A", "src/saliency/image_saliency.cpp"}},
             {kEngine},
             shareSaliency}};
}

} // namespace pellucid::cli
