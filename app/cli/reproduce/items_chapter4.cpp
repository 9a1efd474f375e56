// Visibility-weighted saliency: figures 4.1 to 4.12, 4.18 and 4.19.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/round_numbers.h"
#include "report/drawing_file.h"
#include "reproduce/desk.h"
#include "tf/lch.h"
#include "tf/shapes.h"
#include "volume/loader.h"

namespace pellucid::cli {

namespace {

const ReproducedEquation kFeature{"4.1", "src/tf/feature.h"}, kColor{"4.2", "src/render/cpu/ray_packets.inl"},
    kAlpha{"4.3", "src/render/cpu/ray_packets.inl"}, kVisibility{"4.4", "src/render/cpu/sweep_kernel.inl"},
    kVisibilityField{"4.5", "src/render/cpu/sweep_kernel.inl"}, kAverage{"4.6", "src/saliency/appearance.h"},
    kWeights{"4.7", "src/saliency/appearance.h"}, kSaliency{"4.8", "src/saliency/saliency_field.cpp"},
    kVoxelVws{"4.9", "src/optimize/fields.cpp"}, kVwsField{"4.10", "src/optimize/fields.cpp"},
    kFeatureField{"4.11", "src/optimize/fields.cpp"}, kVwsOfBoth{"4.13", "src/saliency/vws.cpp"};

// --- Three disks ---

const DataNeed kDisks{"the synthetic disks", "disks"};
const char *const kFromLeft = "-60,20", *const kFromRight = "60,20";

std::size_t leaderOf(const std::vector<FeatureFigures>& features, double FeatureFigures::*figure) {
    return static_cast<std::size_t>(std::ranges::max_element(features, {}, figure) - features.begin());
}

/// "first disk 0.5293, middle disk 0.3002, last disk 0.1705"
std::string listOf(const std::vector<FeatureFigures>& features, double FeatureFigures::*figure) {
    std::string list;
    for (const FeatureFigures& f : features) list += (list.empty() ? "" : ", ") + f.name + " " + figureText(f.*figure);
    return list;
}

ReproducedTable sharesOf(const std::string& caption, const std::vector<FeatureFigures>& features) {
    ReproducedTable table{caption, {"feature", "visibility", "VWS of brightness", "of saturation", "VWS"}, {}};
    for (const FeatureFigures& f : features)
        table.rows.push_back(
            {f.name, figureText(f.visibility), figureText(f.brightness), figureText(f.saturation), figureText(f.vws)});
    return table;
}

void fieldsOfDisks(Desk& desk) {
    const Source disks = desk.data();
    const std::string tf = desk.tf("disks");
    struct SideView {
        std::string name, words, view;
        std::size_t nearest;
    };
    for (const SideView& side :
         {SideView{"left", "on the left", kFromLeft, 0}, SideView{"right", "on the right", kFromRight, 2}}) {
        const Words words = disks.words + Words{"--tf", tf, "--view", side.view};
        desk.render(side.name + ".png", "4.1", "the disks from a viewpoint " + side.words, words);
        desk.render(side.name + "_visibility.png", "4.1", "their visibility field, from the same viewpoint",
                    words + Words{"--field", "visibility"});
        const auto features = featuresOf(desk.ask(side.name, Words{"measure"} + words));
        desk.statement("4.3.2",
                       "The visibility fields display how tissues in the front occlude those in the back: from the " +
                           side.name + " the nearest disk contributes most.",
                       leaderOf(features, &FeatureFigures::visibility) == side.nearest,
                       "visibility of " + listOf(features, &FeatureFigures::visibility));
    }
}

void saliencyOfDisks(Desk& desk) {
    const Source disks = desk.data();
    const Words words = disks.words + Words{"--tf", desk.tf("disks"), "--view", kFromLeft};
    desk.render("brightness.png", "4.2 (a)", "saliency of brightness", words + Words{"--field", "saliency-brightness"});
    desk.render("saturation.png", "4.2 (b)", "saliency of saturation", words + Words{"--field", "saliency-saturation"});
}

/// Saliency along the line through the middle of the volume, and where the disks lie on it.
struct Profile {
    std::vector<double> saliency;
    std::vector<int> disk; ///< index of the disk that the voxel belongs to, −1: none
};

Profile profileOf(const Desk& desk, const Source& disks, const std::string& field, const TransferFunction& tf) {
    VolumeSource source;
    source.path = desk.pathOf(field).string();
    const Volume saliency = loadVolume(source);
    VolumeSource data;
    data.path = disks.words.front();
    data.sampleSize = desk.settings().sampleSize;
    const Volume volume = loadVolume(data);
    const Int3 d = volume.dims();
    Profile profile;
    for (int x = 0; x < d.x; ++x) {
        const auto index = static_cast<std::size_t>(x + d.x * (d.y / 2 + d.y * (d.z / 2)));
        profile.saliency.push_back(saliency.value(index));
        profile.disk.push_back(featureAt(tf.features, volume.intensity(index)));
    }
    return profile;
}

void drawProfile(Desk& desk, const Profile& profile, const TransferFunction& tf) {
    Plot plot{.title = "Saliency of brightness through the middle of the disks",
              .x = {.label = "voxel along x", .hi = static_cast<double>(profile.saliency.size() - 1), .whole = true},
              .y = {.label = "saliency"},
              .series = {{.name = "saliency", .points = {}}}};
    for (std::size_t x = 0; x < profile.saliency.size(); ++x) {
        plot.series[0].points.push_back({static_cast<double>(x), profile.saliency[x]});
        if (profile.disk[x] < 0) continue;
        const auto at = static_cast<double>(x);
        if (x > 0 && profile.disk[x] == profile.disk[x - 1])
            plot.bars.back().to = at + 0.5;
        else
            plot.bars.push_back({at - 0.5, at + 0.5, 1, tf.features[static_cast<std::size_t>(profile.disk[x])].color});
    }
    fitLinear(plot, 1);
    const std::string file = desk.file("profile.svg");
    writeDrawing([&](const PlotPage& page) { return drawingOf(plot, page); }, {}, desk.pathOf(file).string());
    desk.picture(file, "4.3", "the same in numbers: bars in the colours of the disks show where they are solid");
}

void hollowDisks(Desk& desk) {
    const Source disks = desk.data();
    const std::string tfFile = desk.tf("disks");
    const Words clipped = disks.words + Words{"--tf", tfFile, "--view", "-25,20", "--clip", "y:0.5:1"};
    desk.render("saliency.png", "4.3 (a)", "the saliency field of brightness, cut open",
                clipped + Words{"--field", "saliency-brightness"});
    desk.render("volume.png", "4.3 (b)", "the volume, cut open alike", clipped);
    desk.run(Words{"fields"} + disks.words + Words{"--tf", tfFile, "--out", desk.file("fields")});
    const TransferFunction tf = desk.readTf(tfFile);
    const Profile profile = profileOf(desk, disks, desk.file("fields/saliency_brightness.nrrd"), tf);
    drawProfile(desk, profile, tf);

    bool allHollow = true;
    std::string figures;
    for (std::size_t f = 0; f < tf.features.size(); ++f) {
        std::vector<double> inside;
        for (std::size_t x = 0; x < profile.disk.size(); ++x)
            if (profile.disk[x] == static_cast<int>(f)) inside.push_back(profile.saliency[x]);
        if (inside.empty()) continue;
        const double middle = inside[inside.size() / 2], face = std::min(inside.front(), inside.back());
        allHollow = allHollow && middle < 0.5 * face;
        figures += (figures.empty() ? "" : "; ") + tf.features[f].name + " " + figureText(face) + " at its faces, " +
                   figureText(middle) + " in its middle";
    }
    desk.statement("4.3.3",
                   "The saliency field emphasizes the center and de-emphasizes the surroundings: the three solid disks "
                   "are hollow in it.",
                   allHollow, figures);
}

void vwsFieldsOfDisks(Desk& desk) {
    const Source disks = desk.data();
    const std::string tf = desk.tf("disks_translucent");
    const char* const letters[] = {"a", "b", "c", "d", "e", "f"};
    int n = 0;
    for (const auto& [side, view] : {std::pair{"left", kFromLeft}, std::pair{"right", kFromRight}})
        for (const char* const disk : {"first disk", "middle disk", "last disk"}) {
            const std::string letter = letters[n++];
            desk.render(letter + ".png", "4.4 (" + letter + ")",
                        std::string("VWS of the ") + disk + ", from the " + side,
                        disks.words + Words{"--tf", tf, "--view", view, "--field", "vws", "--feature", disk});
        }
    desk.remark(
        "All pictures of the field use the same colour scale, so a disk that is hidden by another one is dark.");
}

/// The captions of figures 4.5 and 4.6.
void sayWhichDiskLeads(Desk& desk, const std::string& figure, const std::vector<FeatureFigures>& features,
                       std::size_t nearest) {
    const std::string name = nearest == 0 ? "top" : "bottom";
    const auto leads = [&](double FeatureFigures::*by) { return leaderOf(features, by) == nearest; };
    desk.statement("4.3.5",
                   "Figure " + figure + ": the " + name + " disk is the most visible according to feature visibility.",
                   leads(&FeatureFigures::visibility), listOf(features, &FeatureFigures::visibility));
    desk.statement("4.3.5",
                   "Figure " + figure + ": the " + name +
                       " disk is the most salient according to saliency of brightness.",
                   leads(&FeatureFigures::brightness), listOf(features, &FeatureFigures::brightness));
    desk.statement("4.3.5",
                   "Figure " + figure +
                       ": the middle disk (magenta) is more salient than the others in terms of saturation.",
                   leaderOf(features, &FeatureFigures::saturation) == 1, listOf(features, &FeatureFigures::saturation));
    const auto order = [&](double FeatureFigures::*by) {
        std::array<std::size_t, 3> places{0, 1, 2};
        std::ranges::sort(places, std::greater(), [&](std::size_t f) { return features[f].*by; });
        return places;
    };
    desk.statement(
        "4.3.5", "Figure " + figure + ": the saliency of brightness shows similar patterns as the feature visibility.",
        order(&FeatureFigures::visibility) == order(&FeatureFigures::brightness),
        "the order of the disks is " +
            std::string(order(&FeatureFigures::visibility) == order(&FeatureFigures::brightness) ? "the same"
                                                                                                 : "not the same"));
}

/// By how much the middle disk leads in saturation: the captions call it significant.
void sayHowFarSaturationLeads(Desk& desk, const std::vector<FeatureFigures>& features, const std::string& side) {
    const double next = std::max(features[0].saturation, features[2].saturation);
    desk.remark("From the " + side + " the middle disk leads in saturation by a factor of " +
                fixedText(features[1].saturation / next, 2) +
                "; the factor depends on the two greens, which the thesis does not give in numbers.");
}

void barsOfDisks(Desk& desk) {
    const Source disks = desk.data();
    const std::string tf = desk.tf("disks_translucent");
    struct SideView {
        std::string name, view, figure;
        std::size_t nearest;
    };
    for (const SideView& side : {SideView{"left", "-90,0", "4.5", 0}, SideView{"right", "90,0", "4.6", 2}}) {
        const Words words = disks.words + Words{"--tf", tf, "--view", side.view};
        const std::string bars = desk.file(side.name + "_bars.svg");
        desk.render(side.name + ".png", side.figure, "the disks, translucent, from the " + side.name, words);
        const auto features = featuresOf(desk.ask(side.name, Words{"measure"} + words + Words{"--bars", bars}));
        desk.picture(bars, side.figure + " (a) to (d)", "visibility; VWS of brightness, of saturation, of both");
        desk.table(sharesOf("Figure " + side.figure, features));
        sayWhichDiskLeads(desk, side.figure, features, side.nearest);
        sayHowFarSaturationLeads(desk, features, side.name);
    }
    const auto oblique =
        featuresOf(desk.ask("oblique", Words{"measure"} + disks.words + Words{"--tf", tf, "--view", kFromRight}));
    desk.remark("Both views look along the row of disks. From the right and 20° above, where the front disk hides less "
                "of the others, the " +
                oblique[leaderOf(oblique, &FeatureFigures::visibility)].name + " leads in visibility, the " +
                oblique[leaderOf(oblique, &FeatureFigures::brightness)].name + " in brightness, the " +
                oblique[leaderOf(oblique, &FeatureFigures::saturation)].name + " in saturation.");
}

// --- A tooth ---

const DataNeed kTooth{"tooth (140×120×161)", "disks", "tooth/tooth.mhd"};

/// A view that shows all three features, and opacities under which each of them is seen: of the tooth and of what
/// stands for it.
struct ToothLook {
    const char* view;
    double equal;
};
ToothLook lookOf(const Source& source) { return source.isReal ? ToothLook{"0,20", 0.1} : ToothLook{kFromLeft, 0.07}; }

std::array<double, 3> equalPeaks(const Source& source) {
    const double peak = lookOf(source).equal;
    return {peak, peak, peak};
}

/// Three tents in the colours of figure 4.7. Of the tooth they lie where the author's published transfer function has
/// them; of what stands for it, where its parts lie.
TransferFunction threeParts(const Source& source, const std::array<double, 3>& peaks) {
    struct Part {
        const char* name;
        Rgb color;
        double a, b;
    };
    const std::array<Part, 3> tooth{{{"cementum & pulp chamber", {0, 0, 1}, 0.04, 0.5},
                                     {"dentine", {1, 0, 0}, 0.58, 0.7},
                                     {"enamel", {1, 1, 0}, 0.76, 1}}};
    const std::vector<Feature> disks = tents(3).features;
    TransferFunction tf;
    for (std::size_t i = 0; i < tooth.size(); ++i) {
        const auto [a, b] = source.isReal ? std::pair(tooth[i].a, tooth[i].b) : std::pair(disks[i].a, disks[i].b);
        tf = withShapeAdded(tf, {ShapeKind::Tent, a, b, peaks[i], tooth[i].color, tooth[i].name}).tf;
    }
    return tf;
}

/// A picture of the tooth, the fields of its features and its bars; what they measure.
std::vector<FeatureFigures> lookAtTooth(Desk& desk, const Source& tooth, const std::string& name,
                                        const TransferFunction& tf, const std::array<std::string, 3>& figures) {
    const Words words = tooth.words + Words{"--tf", desk.writeTf(name, tf), "--view", lookOf(tooth).view};
    desk.render(name + ".png", figures[0], "under three tents", words);
    for (std::size_t f = 0; f < tf.features.size() && !figures[1].empty(); ++f)
        desk.render(name + "_vws" + std::to_string(f + 1) + ".png",
                    figures[1] + " (" + std::string(1, static_cast<char>('a' + f)) + ")",
                    "VWS of " + tf.features[f].name,
                    words + Words{"--field", "vws", "--feature", tf.features[f].name, "--field-colormap", "feature"});
    const std::string bars = desk.file(name + "_bars.svg");
    const auto features = featuresOf(desk.ask(name, Words{"measure"} + words + Words{"--bars", bars}));
    desk.picture(bars, figures[2], "feature visibility and visibility-weighted saliency");
    desk.table(sharesOf("Figure " + figures[2], features));
    return features;
}

void compareTfs(Desk& desk) {
    const Source tooth = desk.data();
    const auto equal = lookAtTooth(desk, tooth, "equal", threeParts(tooth, equalPeaks(tooth)), {"4.7", "4.8", "4.9"});
    const auto enamel =
        lookAtTooth(desk, tooth, "enamel", threeParts(tooth, {0.02, 0.02, 0.6}), {"4.10", "4.11", "4.12"});
    desk.statement("4.4", "Under equal opacities all three features are reasonably salient.",
                   std::ranges::all_of(equal, [](const FeatureFigures& f) { return f.vws >= 0.1; }),
                   "VWS of a tenth or more each: " + listOf(equal, &FeatureFigures::vws));
    desk.statement("4.4", "The second transfer function gives the enamel significantly higher visual saliency.",
                   enamel[2].vws > 1.5 * equal[2].vws && leaderOf(enamel, &FeatureFigures::vws) == 2,
                   "VWS of the enamel " + figureText(equal[2].vws) + " → " + figureText(enamel[2].vws) +
                       ", the most of the three");
    desk.statement("4.4",
                   "Feature visibility and VWS summarize the visibility and saliency of the features: both rise.",
                   enamel[2].visibility > equal[2].visibility && enamel[2].vws > equal[2].vws,
                   "visibility " + figureText(equal[2].visibility) + " → " + figureText(enamel[2].visibility));
    if (!tooth.isReal)
        desk.remark("Here the three features are the disks of a sample, and the last of them stands for the enamel; "
                    "--data gives access to the tooth itself.");
}

/// The same lightness and hue, a part of the chroma.
Rgb paler(const Rgb& color, double part) {
    Lch lch = lchFromSrgb(color);
    lch.chroma *= part;
    return srgbFromLch(lch);
}

void reduceSaturation(Desk& desk) {
    const Source tooth = desk.data();
    const TransferFunction full = threeParts(tooth, equalPeaks(tooth));
    TransferFunction pale = full;
    const Rgb red = full.features[1].color;
    pale.features[1].color = paler(red, 0.3);
    for (ControlPoint& p : pale.points)
        if (p.color == red) p.color = pale.features[1].color;
    const auto before = lookAtTooth(desk, tooth, "full", full, {"4.18 (a)", "", "4.18 (b), (c)"});
    const auto after = lookAtTooth(desk, tooth, "pale", pale, {"4.19 (a)", "", "4.19 (b), (c)"});
    double most = 0;
    for (std::size_t f = 0; f < before.size(); ++f)
        most = std::max(most, std::abs(before[f].visibility - after[f].visibility));
    desk.statement("4.5.6", "The feature visibility is not aware of the saturation change: it is the same.", most == 0,
                   most == 0 ? "no difference in any digit" : "largest difference " + figureText(most));
    desk.statement("4.5.6", "The red feature has lower VWS.", after[1].vws < before[1].vws,
                   figureText(before[1].vws) + " → " + figureText(after[1].vws));
    desk.statement("4.5.6", "The yellow feature has higher VWS.", after[2].vws > before[2].vws,
                   figureText(before[2].vws) + " → " + figureText(after[2].vws));
    desk.remark("The red keeps its lightness and hue in CIELCh and has three tenths of its chroma.");
}

} // namespace

std::vector<Item> itemsOfChapter4() {
    const std::vector<ReproducedEquation> measure{kFeature,  kVisibility, kAverage,  kWeights,
                                                  kSaliency, kVws,        kVwsOfBoth};
    return {
        {{"4.1"},
         "Visibility fields from two viewpoints",
         "three solid disks and their visibility fields, from a viewpoint on the left and from one on the right.",
         {kColor, kAlpha, kVisibility, kVisibilityField},
         {kDisks},
         fieldsOfDisks},
        {{"4.2"},
         "Saliency fields of brightness and of saturation",
         "the saliency fields of the disks, computed from brightness and from saturation.",
         {kAverage, kWeights, kSaliency},
         {kDisks},
         saliencyOfDisks},
        {{"4.3"},
         "Solid disks are hollow in the saliency field",
         "clipped views of the saliency field and of the volume.",
         {kAverage, kWeights, kSaliency},
         {kDisks},
         hollowDisks},
        {{"4.4"},
         "Visibility-weighted saliency fields of the disks",
         "the VWS field of each disk, from both viewpoints.",
         {kVoxelVws, kVwsField, kFeatureField},
         {kDisks},
         vwsFieldsOfDisks},
        {{"4.5", "4.6"},
         "Visibility and VWS of the disks as bars",
         "bar charts of feature visibility, VWS of brightness, VWS of saturation and VWS, from both viewpoints.",
         measure,
         {kDisks},
         barsOfDisks},
        {{"4.7", "4.8", "4.9", "4.10", "4.11", "4.12"},
         "Equal opacities, and the enamel emphasized",
         "a tooth under two transfer functions, with the VWS fields of its features and bars of visibility and VWS.",
         measure,
         {kTooth},
         compareTfs},
        {{"4.18", "4.19"},
         "A feature loses saturation",
         "the tooth with a saturated and with a paler red feature: VWS changes, visibility does not.",
         measure,
         {kTooth},
         reduceSaturation}};
}

} // namespace pellucid::cli
