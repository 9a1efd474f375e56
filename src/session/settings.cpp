// The settings of a session, each described once.
#include "session/session.h"
#include "tf/color_maps.h"
#include "tf/terrain.h"

namespace pellucid {

namespace {

using Open = NumberRange::Open;
constexpr NumberRange kAnyNumber{-1e100, 1e100}; // differences of two are numbers too

} // namespace

template <>
std::span<const Setting> settingsOf<MeasureSettings>() {
    using M = MeasureSettings;
    constexpr auto isDefault = [](const void* m) { return static_cast<const M*>(m)->profile == Profile::Default; };
    constexpr auto isPublished = [](const void* m) { return static_cast<const M*>(m)->profile == Profile::Published; };
    static constexpr const char* kQualities[] = {"Normal", "High"};
    static constexpr const char* kEngines[] = {"Automatic", "OpenGL", "CPU", "Slices, as in the thesis",
                                               "Reference (slow)"};
    static constexpr const char* kProfiles[] = {"Pellucid's", "Published"};
    static const Setting kSettings[] = {
        {.key = "profile",
         .at = member<&M::profile>,
         .words = "&Definitions",
         .help = "The definitions of visibility, saliency, VWS, refinement and volatility. Published are those of the "
                 "programs behind the thesis's printed numbers; they measure along an axis of the grid with 8-bit "
                 "opacities and need no camera.",
         .choices = kProfiles},
        {.key = "along",
         .at = member<&M::along>,
         .words = "&Face of the grid",
         .help = "The face of the grid that the published profile looks at: front is that of the highest y, top that "
                 "of the highest z, right that of the highest x.",
         .used = isPublished},
        {.key = "quality",
         .at = member<&M::quality>,
         .words = "&Quality",
         .help = "High halves the error of visibility, about, and the distance of the samples of pictures; it takes at "
                 "least "
                 "twice the time.",
         .choices = kQualities,
         .used = isDefault},
        {.key = "engine",
         .at = member<&M::engine>,
         .words = "&Engine",
         .help = "What computes visibility: auto takes OpenGL on a real GPU and else the CPU; slices is the thesis's "
                 "own method, on OpenGL. All agree within their tolerances.",
         .choices = kEngines,
         .used = isDefault},
    };
    return kSettings;
}

template <>
std::span<const Setting> settingsOf<AdaptSettings>() {
    using A = AdaptSettings;
    constexpr auto adapts = [](const void* a) { return static_cast<const A*>(a)->mode != A::Mode::Static; };
    static constexpr const char* kModes[] = {"static", "refine", "optimize"};
    static const Setting kSettings[] = {
        {.key = "mode",
         .at = member<&A::mode>,
         .words = "Transfer functions",
         .help = "Whether all frames share one transfer function, or each has its own, which is refined by entropy or "
                 "optimized to the targets from that of the frame before.",
         .choices = kModes},
        {.key = "coherence",
         .at = member<&A::coherence>,
         .words = "Coherence",
         .help = "How much jumps of the transfer function from frame to frame are held back: 0 treats each frame for "
                 "itself, inf is a static transfer function. With optimize, opacities change as little over the whole "
                 "series as a distance of a hundredth of this from the targets on average (RMS) allows. With refine, "
                 "it is the weight of the squared steps from frame to frame against those from what was refined. "
                 "Without a number it is 2 with optimize and 0 with refine.",
         .range = {0, NumberRange::kInfinity},
         .used = adapts},
    };
    return kSettings;
}

template <>
std::span<const Setting> settingsOf<HsbMapping>() {
    using H = HsbMapping;
    constexpr auto isOn = [](const void* h) { return static_cast<const H*>(h)->on; };
    constexpr auto hasSaturation = [](const void* h) {
        const H& mapping = *static_cast<const H*>(h);
        return mapping.on && !mapping.saturation.empty();
    };
    constexpr auto hasBrightness = [](const void* h) {
        const H& mapping = *static_cast<const H*>(h);
        return mapping.on && !mapping.brightness.empty();
    };
    static const Setting kSettings[] = {
        {.key = "on",
         .at = member<&H::on>,
         .words = "&Colours from variables",
         .help = "Take saturation, brightness and hue of each voxel from variables; opacity stays with the transfer "
                 "function. Figures are measured with these colours.",
         .option = ""},
        {.key = "saturation",
         .at = member<&H::saturation>,
         .words = "Saturation ←",
         .help = "The variable that saturation comes from, clip(a · X): what has much of it is colourful, what has "
                 "none is grey.",
         .option = "",
         .used = isOn},
        {.key = "brightness",
         .at = member<&H::brightness>,
         .words = "Brightness ←",
         .help = "The variable that brightness comes from, 1 − clip(b · Y): the more of it, the darker.",
         .option = "",
         .used = isOn},
        {.key = "hue",
         .at = member<&H::hue>,
         .words = "Hue ←",
         .help = "The variable that hue comes from; without one all voxels have the same.",
         .option = "",
         .used = isOn},
        {.key = "hue_from",
         .at = member<&H::hueFrom>,
         .words = "Hue from",
         .help = "The hue: 0 is red, 120 green, 240 blue; with a variable, that of its least value.",
         .range = {-360, 720},
         .unit = "°",
         .option = "",
         .used = isOn},
        {.key = "hue_to",
         .at = member<&H::hueTo>,
         .words = "Hue to",
         .help = "The hue of the variable's largest value.",
         .range = {-360, 720},
         .unit = "°",
         .option = "",
         .used = isOn},
        {.key = "a",
         .at = member<&H::a>,
         .words = "a",
         .help = "The factor of saturation: values of 1/a and more are fully saturated. Automatic: 95 % of those above "
                 "0 are not clipped.",
         .range = {0, kLargestScale},
         .none = "auto",
         .option = "",
         .used = hasSaturation},
        {.key = "b",
         .at = member<&H::b>,
         .words = "b",
         .help = "The factor of darkness: values of 1/b and more are black. Automatic: 95 % of those above 0 are not "
                 "clipped.",
         .range = {0, kLargestScale},
         .none = "auto",
         .option = "",
         .used = hasBrightness},
    };
    return kSettings;
}

template <>
std::span<const Setting> settingsOf<GroundView>() {
    using G = GroundView;
    constexpr auto isDrawn = [](const void* g) {
        const G& ground = *static_cast<const G*>(g);
        return !ground.path.empty() && ground.shown;
    };
    static const Setting kSettings[] = {
        {.key = "shown", .at = member<&G::shown>, .words = "&Ground", .help = "Draw the ground.", .option = ""},
        {.key = "color_map",
         .at = member<&G::colorMap>,
         .words = "Colours",
         .help = "The colours of the ground from its lowest to its highest: a colour map, or terrain, which is blue, "
                 "green, brown and white, from 0 on where some heights lie below.",
         .option = "ground-map",
         .used = isDrawn,
         .checkText = [](const std::string& text) { (void)groundColors(text); }},
        {.key = "scale",
         .at = member<&G::scale>,
         .words = "Scale",
         .help = "The length in the world of one unit of height; without a number it is 1 where the largest height "
                 "lies in the box and reaches a hundredth of it, else the highest rises to a tenth of the box.",
         .range = {0, NumberRange::kFinite, Open::Low},
         .option = "ground-scale",
         .used = isDrawn},
        {.key = "relief",
         .at = member<&G::relief>,
         .words = "Relief",
         .help = "How strongly the slopes of the ground are shaded, by a sun at the upper left of the map.",
         .option = "ground-relief",
         .used = isDrawn},
    };
    return kSettings;
}

template <>
std::span<const Setting> settingsOf<OverlayView>() {
    using O = OverlayView;
    constexpr auto isDrawn = [](const void* o) { return static_cast<const O*>(o)->isDrawn(); };
    constexpr auto hasLook = [](const void* o) {
        const O& overlay = *static_cast<const O*>(o);
        return overlay.isDrawn() && !overlay.curve;
    };
    static constexpr const char* kSides[] = {"Automatic", "From the threshold on", "Both signs"};
    static const Setting kSettings[] = {
        {.key = "shown", .at = member<&O::shown>, .words = "&Overlay", .help = "Draw the overlay.", .option = ""},
        {.key = "sides",
         .at = member<&O::sides>,
         .words = "S&ides",
         .help = "Whether the overlay is drawn from the threshold on, as a dose is, or where it is farther from 0 than "
                 "the threshold, below 0 and above it, as a map of t-values is.",
         .choices = kSides,
         .option = "overlay-sides",
         .used = hasLook},
        {.key = "threshold",
         .at = member<&O::threshold>,
         .words = "&Threshold",
         .help = "Value of the overlay up to which nothing of it is drawn; with both signs, its distance from 0. "
                 "Without a number it is a tenth of the largest value; with both signs, the distance that 5 % of the "
                 "values other than 0 exceed.",
         .range = kAnyNumber,
         .none = "auto",
         .option = "overlay-threshold",
         .used = hasLook},
        {.key = "top",
         .at = member<&O::top>,
         .words = "To&p",
         .help =
             "Value of the overlay that its colours reach to; what is beyond it looks the same. Without a number it "
             "is the largest value; with both signs, the distance from 0 that 0.1 % of the values exceed.",
         .range = kAnyNumber,
         .none = "auto",
         .option = "overlay-top",
         .used = hasLook},
        {.key = "color_map",
         .at = member<&O::colorMap>,
         .words = "&Colours",
         .help = "The colour map of the overlay, or auto: blue-red with both signs, else ember.",
         .option = "overlay-map",
         .used = hasLook,
         .checkText =
             [](const std::string& text) {
                 if (text != OverlayView::kAutomatic) (void)colorMapNamed(text);
             }},
        {.key = "opacity",
         .at = member<&O::opacity>,
         .words = "Op&acity",
         .help = "The largest opacity of the overlay, of a path of d0 of the volume; half of it at the threshold. "
                 "Without a number it is 0.1, or that of the overlay's own transfer function.",
         .none = "auto",
         .option = "overlay-opacity",
         .used = isDrawn},
    };
    return kSettings;
}

template <>
std::span<const Setting> settingsOf<DisplaySettings>() {
    using D = DisplaySettings;
    constexpr auto isComposite = [](const void* d) { return static_cast<const D*>(d)->mode == RenderMode::Composite; };
    static constexpr const char* kModes[] = {"Composite", "Maximum (MIP)", "Minimum (MinIP)", "Average", "Surfaces"};
    static const Setting kSettings[] = {
        {.key = "mode",
         .at = member<&D::mode>,
         .words = "&Mode",
         .help = "What becomes of the intensities along a ray: emission and absorption by the transfer function; the "
                 "largest, the smallest or the mean one, as grey; or the first surface of each feature.",
         .choices = kModes},
        {.key = "background",
         .at = member<&D::background>,
         .words = "Background",
         .help = "The colour behind the volume.",
         .option = ""},
        {.key = "background_top",
         .at = member<&D::backgroundTop>,
         .words = "Background at the top",
         .help = "The colour at the top of the picture, if it differs from the bottom.",
         .option = ""},
        {.key = "finest_step",
         .at = member<&D::finestStep>,
         .words = "&Finest step",
         .help = "How short the steps along a ray may become, by halving, where the picture would change by 1/255 "
                 "otherwise. Long steps leave rings where opacity rises steeply; 0.5 draws as fast as can be.",
         .range = {kFinestStep, 16},
         .unit = "d0",
         .used = isComposite},
    };
    return kSettings;
}

template <>
std::span<const Setting> settingsOf<RefineSettings>() {
    static const Setting kSettings[] = {
        {.key = "live",
         .at = member<&RefineSettings::live>,
         .words = "Li&ve",
         .help = "Refine after every edit of the transfer function.",
         .option = ""},
    };
    return kSettings;
}

template <>
std::span<const Setting> settingsOf<SliceViews>() {
    using S = SliceViews;
    static const Setting kSettings[] = {
        {.key = "layout",
         .at = member<&S::layout>,
         .words = "Layout",
         .help = "Which views the window has: the volume alone, four of one size, or the volume and three small ones.",
         .option = ""},
        {.key = "tf_strength",
         .at = member<&S::tfStrength>,
         .words = "Co&lours",
         .help = "How much of the slices the transfer function colours: 0 is grey alone, 1 colours alone. It colours "
                 "what is opaque."},
    };
    return kSettings;
}

template <>
std::span<const Setting> settingsOf<CoordinateSettings>() {
    static constexpr const char* kAxes[] = {"LPS (DICOM, ITK)", "RAS (NIfTI, 3D Slicer)"};
    static const Setting kSettings[] = {
        {.key = "axes",
         .at = member<&CoordinateSettings::axes>,
         .words = "C&oordinates",
         .help =
             "How places of a patient are shown and given: as millimetres to the left, the back and the head, or to "
             "the right, the front and the head. Nothing else changes, and files without a patient keep their own "
             "coordinates.",
         .choices = kAxes,
         .option = "coordinates"},
    };
    return kSettings;
}

template <>
std::span<const Setting> settingsOf<ComparisonView>() {
    using C = ComparisonView;
    constexpr auto hasB = [](const void* c) { return static_cast<const C*>(c)->b.has_value(); };
    constexpr auto isWipe = [](const void* c) {
        return static_cast<const C*>(c)->b && static_cast<const C*>(c)->mode == CompareMode::Wipe;
    };
    constexpr auto isDifference = [](const void* c) {
        return static_cast<const C*>(c)->b && static_cast<const C*>(c)->mode == CompareMode::Difference;
    };
    static constexpr const char* kModes[] = {"Off", "Side by side", "Wipe", "Difference"};
    static const Setting kSettings[] = {
        {.key = "mode",
         .at = member<&C::mode>,
         .words = "&Show",
         .help = "B beside A; both in one picture with a border between them that the mouse moves; or A under a map of "
                 "the colour differences to B.",
         .choices = kModes,
         .option = "",
         .used = hasB},
        {.key = "same_view",
         .at = member<&C::sameView>,
         .words = "Same &view",
         .help = "A and B are seen from one place: turning one turns the other.",
         .option = "",
         .used = hasB},
        {.key = "same_frame",
         .at = member<&C::sameFrame>,
         .words = "Same &frame",
         .help = "B follows the frames of the series; else it stays at its own.",
         .option = "",
         .used = hasB},
        {.key = "same_look",
         .at = member<&C::sameLook>,
         .words = "Same &light and clipping",
         .help = "B is lit, displayed and cut as A is; else as it was when it was taken.",
         .option = "",
         .used = hasB},
        {.key = "divider",
         .at = member<&C::divider>,
         .words = "&Border",
         .help = "The share of the width that A has of a wipe.",
         .range = {0, 1},
         .option = "",
         .used = isWipe},
        {.key = "strength",
         .at = member<&C::strength>,
         .words = "S&trength",
         .help = "The opacity of the difference over the picture where it is largest.",
         .range = {0, 1, Open::Low},
         .option = "",
         .used = isDifference},
    };
    return kSettings;
}

template <>
std::span<const Setting> settingsOf<PictureSaliencyView>() {
    using P = PictureSaliencyView;
    constexpr auto isOn = [](const void* p) { return static_cast<const P*>(p)->on; };
    static constexpr const char* kMaps[] = {"Nothing", "The whole picture", "The selected feature",
                                            "What no feature has"};
    static const Setting kSettings[] = {
        {.key = "on",
         .at = member<&P::on>,
         .words = "2D feature &saliency",
         .help = "Looks at the picture whenever it rests, and says how much of what catches the eye each feature has.",
         .option = ""},
        {.key = "map",
         .at = member<&P::map>,
         .words = "Map over the &picture",
         .help = "Lays over the picture how much each place catches the eye: in all, of the selected feature, or where "
                 "no feature is drawn.",
         .choices = kMaps,
         .option = "",
         .used = isOn},
        {.key = "strength",
         .at = member<&P::strength>,
         .words = "S&trength",
         .help = "The opacity of the map at its largest value.",
         .range = {0, 1, Open::Low},
         .option = "",
         .used = isOn},
    };
    return kSettings;
}

template <>
std::span<const Setting> settingsOf<FieldView>() {
    using F = FieldView;
    constexpr auto isOn = [](const void* f) { return static_cast<const F*>(f)->kind.has_value(); };
    static const Setting kSettings[] = {
        {.key = "kind",
         .at = member<&F::kind>,
         .words = "&Field",
         .help = "Draws what each voxel contributes to this picture instead of the data, by emission and "
                 "absorption and without light.",
         .none = "none",
         .option = "field"},
        {.key = "color_map",
         .at = member<&F::colorMap>,
         .words = "&Colours",
         .help = "The colours from 0 to the top of the field: a colour map, or feature for black over the feature's "
                 "colour to white.",
         .option = "field-colormap",
         .used = isOn,
         .checkText = checkFieldColorMap},
        {.key = "strength",
         .at = member<&F::strength>,
         .words = "Strength",
         .help = "The opacity of a path of one reference length, the smallest voxel spacing, at the top of the field; "
                 "it falls evenly to 0 at the threshold.",
         .range = {0, 1, Open::Low},
         .option = "field-strength",
         .used = isOn},
        {.key = "threshold",
         .at = member<&F::threshold>,
         .words = "Threshold",
         .help = "Values up to this share of the top are not drawn.",
         .range = {0, 1, Open::High},
         .option = "field-threshold",
         .used = isOn},
        {.key = "top",
         .at = member<&F::top>,
         .words = "Top",
         .help = "The value that the colours reach to, in the unit of the field; without one, 99.9 % of the values "
                 "above 0 lie below it.",
         .range = {0, NumberRange::kFinite, Open::Low},
         .option = "field-top",
         .used = isOn},
    };
    return kSettings;
}

} // namespace pellucid
