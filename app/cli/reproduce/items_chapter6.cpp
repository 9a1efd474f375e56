// Selective saturation and brightness: figures 6.1 to 6.7.
#include <algorithm>
#include <cmath>

#include "base/round_numbers.h"
#include "base/statistics.h"
#include "image_io/image_file.h"
#include "reproduce/desk.h"

namespace pellucid::cli {

namespace {

const DataNeed kHurricane{"Hurricane Isabel (500×500×100, 48 time steps)", "hurricane"};
const DataNeed kSmoke{"simulated smoke (fluid after Fedkiw et al.)", "smoke"};
const ReproducedEquation kMapping{"6.1", "src/tf/hsb_colors.cpp"};
const std::string kAbove = "0,89", kAside = "20,35"; // directions of view
constexpr const char* kGuideSize = "192x192";        ///< of pictures that statements are computed from

/// A variable in grey: opaque where it is high. A saturation that is scaled down to nothing leaves none.
Words greyOf(const std::string& variable) {
    return {"--hsb", "alpha=" + variable + ",saturation=" + variable + ",a=1e-6"};
}

/// Without ground, on nothing: what a statement compares.
Image guide(Desk& desk, const std::string& name, const Words& words) {
    const std::string file = desk.file(name + ".exr");
    desk.run(Words{"render"} + words + Words{"--background", "transparent", "--size", kGuideSize, "--out", file});
    return readImage(desk.pathOf(file).string());
}

/// How strongly what a picture shows in colour goes with how opaque another variable is there (Spearman), over the
/// pixels where the picture has more than a trace.
struct Together {
    double saturation = 0, brightness = 0;
    std::size_t pixels = 0;
};

Together togetherOf(const Image& picture, const Image& saturating, const Image& darkening) {
    constexpr float kTrace = 0.05f;
    std::vector<double> saturation, brightness, first, second;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const float* p = picture.pixel(x, y);
            if (p[3] < kTrace) continue;
            const Hsv hsv = hsvFromRgb({p[0], p[1], p[2]});
            saturation.push_back(hsv.saturation);
            brightness.push_back(hsv.value);
            first.push_back(saturating.pixel(x, y)[3]);
            second.push_back(darkening.pixel(x, y)[3]);
        }
    return {coefficient(CorrelationKind::Spearman, saturation, first),
            coefficient(CorrelationKind::Spearman, brightness, second), saturation.size()};
}

void sayColours(Desk& desk, const std::string& saturated, const std::string& darkened, const Together& together) {
    const std::string over = " over " + std::to_string(together.pixels) + " pixels";
    desk.statement("6.4", saturated, together.saturation > 0.2,
                   "Spearman's correlation of saturation and volatility is " + fixedText(together.saturation, 2) +
                       over);
    desk.statement("6.4", darkened, together.brightness < -0.2,
                   "Spearman's correlation of brightness and the second variable is " +
                       fixedText(together.brightness, 2) + over);
}

// ---- The hurricane ------------------------------------------------------------------------------------------------

/// The series with its rain, at a frame; `isSwapped`: rain is X and cloud Y.
Words hurricane(Desk& desk, int frame, bool isSwapped = false) {
    Source cloud = desk.data();
    const std::string x = isSwapped ? "sample:hurricane/precipitation" : "sample:hurricane",
                      y = isSwapped ? "sample:hurricane" : "sample:hurricane/precipitation";
    cloud.words.front() = x;
    return cloud.words + Words{"--frame", std::to_string(frame), "--variable", "y=" + y};
}
const Words kGround{"--ground", "sample:hurricane/ground"};

/// Cloud, rain and how volatile the cloud is, for reference.
void hurricaneInGrey(Desk& desk) {
    const Words words = hurricane(desk, 40) + Words{"--view", kAbove};
    desk.render("cloud.png", "6.1 (a)", "cloud at frame 40", words + greyOf("x") + kGround);
    desk.render("rain.png", "6.1 (b)", "precipitation at frame 40", words + greyOf("y") + kGround);
    std::vector<double> covers;
    const std::string parts = "abc";
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string frames = std::to_string(5 << i), name = "volatility" + frames;
        const Words volatile_ = words + Words{"--variable", "v=volatility:x:" + frames} + greyOf("v");
        desk.render(name + ".png", std::string("6.2 (") + parts[i] + ")",
                    "volatility of cloud over " + frames + " frames", volatile_ + kGround);
        const Image image = guide(desk, name, volatile_);
        double sum = 0;
        for (std::size_t a = 3; a < image.rgba.size(); a += 4) sum += image.rgba[a];
        covers.push_back(4 * sum / static_cast<double>(image.rgba.size()));
    }
    desk.table({"How much of the picture each volatility covers (mean alpha)",
                {"frames", "covers"},
                {{"5", figureText(covers[0])}, {"10", figureText(covers[1])}, {"20", figureText(covers[2])}}});
    desk.remark("The thesis compares nothing here. The longer the window, the longer the trail that the eye leaves.");
}

/// Figures 6.3 and 6.4.
void hurricaneInColour(Desk& desk) {
    const Words mapping{"--hsb", "alpha=x,saturation=volatility:x:10,brightness=y,hue=0,a=10,b=5"};
    const std::string parts = "abc";
    for (std::size_t i = 0; i < 3; ++i) {
        const int frame = 35 + 5 * static_cast<int>(i);
        desk.render("frame" + std::to_string(frame) + ".png", std::string("6.3 (") + parts[i] + ")",
                    "frame " + std::to_string(frame),
                    hurricane(desk, frame) + Words{"--view", kAbove} + mapping + kGround);
    }
    desk.render("aside.png", "6.4 (a)", "frame 40, in perspective",
                hurricane(desk, 40) + Words{"--view", kAside} + mapping + kGround);
    desk.render("cyan.png", "6.4 (b)", "both saturation and brightness from precipitation",
                hurricane(desk, 40) +
                    Words{"--view", kAside, "--hsb", "alpha=x,saturation=y,brightness=y,hue=180,a=10,b=10"} + kGround);

    const Words seen = hurricane(desk, 40) + Words{"--view", kAbove};
    const Image picture = guide(desk, "picture", seen + mapping),
                before = guide(desk, "before", hurricane(desk, 35) + Words{"--view", kAbove} + greyOf("x")),
                volatile_ = guide(desk, "volatile", seen + Words{"--variable", "v=volatility:x:10"} + greyOf("v")),
                rain = guide(desk, "rain", seen + greyOf("y"));
    const Together together = togetherOf(picture, volatile_, rain);
    const Together trail = togetherOf(picture, before, rain);
    desk.statement("6.4", "The strong red indicates where the hurricane was in previous several frames.",
                   trail.saturation > 0.2,
                   "Spearman's correlation of saturation at frame 40 and the cloud of frame 35 is " +
                       fixedText(trail.saturation, 2) + " over " + std::to_string(trail.pixels) + " pixels");
    sayColours(desk, "Saturation shows the volatility of the cloud.",
               "The clouds with more precipitation are darker in the images.", together);
    const Image cyan =
        guide(desk, "cyan", seen + Words{"--hsb", "alpha=x,saturation=y,brightness=y,hue=180,a=10,b=10"});
    const Together dark = togetherOf(cyan, rain, rain);
    desk.statement("6.4", "In cyan, parts of the hurricane are darkened based on the precipitation.",
                   dark.brightness < -0.2,
                   "Spearman's correlation of brightness and precipitation is " + fixedText(dark.brightness, 2));
}

void hurricaneSwapped(Desk& desk) {
    const Words mapping{"--hsb", "alpha=x,saturation=volatility:x:10,brightness=y,hue=0,a=10,b=5"};
    const std::string parts = "abc";
    for (std::size_t i = 0; i < 3; ++i) {
        const int frame = 35 + 5 * static_cast<int>(i);
        desk.render("frame" + std::to_string(frame) + ".png", std::string("6.5 (") + parts[i] + ")",
                    "frame " + std::to_string(frame),
                    hurricane(desk, frame, true) + Words{"--view", kAbove} + mapping + kGround);
    }
    const Words seen = hurricane(desk, 40, true) + Words{"--view", kAbove};
    sayColours(desk, "The precipitation is desaturated based on its volatility.", "It is darkened based on the cloud.",
               togetherOf(guide(desk, "picture", seen + mapping),
                          guide(desk, "volatile", seen + Words{"--variable", "v=volatility:x:10"} + greyOf("v")),
                          guide(desk, "cloud", seen + greyOf("y"))));
}

// ---- The smoke ----------------------------------------------------------------------------------------------------

void smoke(Desk& desk) {
    // Frame 100 of the sample, with as many before it as its volatility needs.
    const Words words =
        desk.data().words + Words{"--frames",          "90:103",     "--frame",      "10",     "--variable",
                                  "v=volatility:x:10", "--variable", "g=gradient:x", "--view", "0,0"};
    desk.render("density.png", "6.6 (a)", "smoke density", words + greyOf("x"));
    desk.render("volatility.png", "6.6 (b)", "its volatility over 10 frames", words + greyOf("v"));
    desk.render("gradient.png", "6.6 (c)", "its gradient magnitude", words + greyOf("g"));
    const std::string scales = "alpha=x,saturation=v,brightness=g,a=10,b=5,";
    const Words byDensity{"--hsb", scales + "hue=x"}, red{"--hsb", scales + "hue=0"};
    desk.render("hue.png", "6.7 (a)", "hue from the density, a = 10, b = 5", words + byDensity);
    desk.render("red.png", "6.7 (b)", "the same in red", words + red);
    sayColours(desk, "Parts of the smoke are desaturated based on the volatility.",
               "Parts of the smoke are darkened based on the gradient magnitude.",
               togetherOf(guide(desk, "red", words + red), guide(desk, "volatile", words + greyOf("v")),
                          guide(desk, "steep", words + greyOf("g"))));
    desk.remark("Frame 100 of the sample stands in for frame 160. Density is normalized over frames 90 to 103.");
}

} // namespace

std::vector<Item> itemsOfChapter6() {
    return {{{"6.1", "6.2"},
             "The hurricane's variables",
             "cloud, precipitation and the volatility of cloud over 5, 10 and 20 frames, at frame 40.",
             {{"6.1", "src/volume/derived.cpp"}},
             {kHurricane},
             hurricaneInGrey},
            {{"6.3", "6.4"},
             "Volatility as saturation, precipitation as darkness",
             "three frames of the hurricane, and frame 40 in perspective, also in cyan.",
             {kMapping},
             {kHurricane},
             hurricaneInColour},
            {{"6.5"},
             "The variables swapped",
             "precipitation as opacity, its volatility as saturation, and the cloud as darkness.",
             {kMapping},
             {kHurricane},
             hurricaneSwapped},
            {{"6.6", "6.7"},
             "Smoke, with its gradient magnitude",
             "smoke density, volatility and gradient magnitude, and the three in one picture.",
             {kMapping},
             {kSmoke},
             smoke}};
}

} // namespace pellucid::cli
