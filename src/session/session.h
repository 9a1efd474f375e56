// All that a user has decided, as one value: what is shown, how it is shown, from where, and what it should become.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/setting.h"
#include "optimize/fields.h"
#include "optimize/optimizer.h"
#include "optimize/refine/refine.h"
#include "render/annotation.h"
#include "render/engine_choice.h"
#include "render/image_region.h"
#include "render/profile.h"
#include "render/render_settings.h"
#include "render/view.h"
#include "saliency/saliency_field.h"
#include "session/keyframes.h"
#include "session/part.h"
#include "tf/transfer_function.h"
#include "volume/derived.h"
#include "volume/loader.h"
#include "volume/orientation.h"
#include "volume/ruler.h"

namespace pellucid {

/// A transfer function that was made for a frame, and what it was made of.
struct AdaptedTf {
    Part<TransferFunction> tf;
    std::string basis; ///< fingerprint of all that it depends on (adapt.h); another one now: it is to be made anew
    /// The same after all frames from key to key were smoothed together, and the fingerprint of that; empty: not yet.
    std::optional<Part<TransferFunction>> smooth = {};
    std::string smoothBasis = {};

    const Part<TransferFunction>& shown() const { return smooth ? *smooth : tf; }
    bool operator==(const AdaptedTf&) const = default;
};

/// The transfer function of a variable over time.
struct TfTrack {
    std::map<int, Part<TransferFunction>> keys; ///< key frame → transfer function, in the data units of its `range`
    std::map<int, AdaptedTf> adapted;           ///< what AdaptSettings made of them, for frames from the first key on

    /// By hand: between two keys with the same points and features halfway from the one to the other, else the latest
    /// key that is not after `frame`, else the first. Null where there are no keys.
    std::shared_ptr<const TransferFunction> at(int frame) const;
    /// The key that `frame` goes back to: the latest not after it, else the first; −1 without keys.
    int keyBefore(int frame) const;
    bool operator==(const TfTrack&) const = default;
};

/// What AdaptSettings::coherence is with the mode Optimize where nobody says (docs/method.md, "Transfer functions over
/// time").
inline constexpr double kUsualCoherence = 2;

/// How transfer functions follow the frames of a series (docs/method.md, "Transfer functions over time"). A key is what
/// frames begin with: where transfer functions follow, that of its own frame is made of it, too.
struct AdaptSettings {
    enum class Mode {
        Static,  ///< keys alone
        Refine,  ///< each frame's refined transfer function starts the next one's (§3.4.4)
        Optimize ///< each frame to the targets, from the one before (§5.4.1)
    };
    Mode mode = Mode::Static;
    /// How much jumps from frame to frame are held back; infinity: as static; empty: kUsualCoherence to optimize,
    /// else none.
    std::optional<double> coherence = {};
    double usedCoherence() const { return coherence.value_or(mode == Mode::Optimize ? kUsualCoherence : 0); }
    bool operator==(const AdaptSettings&) const = default;
};
template <>
std::span<const Setting> settingsOf<AdaptSettings>();
template <>
inline constexpr auto kNamesOf<AdaptSettings::Mode> = enumNames("mode", "static", "refine", "optimize");

/// One variable of the data: where it comes from, and how its values are read and drawn.
struct Variable {
    std::string name = "x";
    VolumeSource source;                  ///< its `range` and `then` are not used: the window is below
    std::optional<Derivation> derivation; ///< made of another variable; `source` is not used then
    std::optional<ValueRange>
        window; ///< data units of intensity 0 and 1; empty: smallest and largest value of all frames
    TfTrack track;
    std::string extraJson; ///< unknown keys of the file it came from

    bool operator==(const Variable&) const = default;
};

/// Colours by several variables in place of those of the transfer function (docs/method.md, "Selective saturation and
/// brightness"). The first variable of the session drives opacity. Channels name variables, plain or derived
/// (Derivation::text()).
struct HsbMapping {
    bool on = false;
    std::string saturation, brightness, hue; ///< empty: saturation and brightness 1, hue `hueFrom`
    std::optional<double> a, b;              ///< scales of saturation and darkness; empty: automaticScale()
    double hueFrom = 0, hueTo = 240;         ///< degrees, at intensity 0 and 1 of the variable `hue`
    /// automaticScale() of the variables in the frame where the mapping began, for a and b where they are empty: kept,
    /// so that frames can be compared. Set by resolve(); of other variables it means nothing.
    struct Found {
        std::string saturation, brightness;
        std::optional<double> a, b;
        bool operator==(const Found&) const = default;
    };
    Found found = {};
    /// Whether `later` is the same decision, and has found again what this one had found: frames are compared under it.
    /// What this one had not, it may have found since.
    bool isKeptBy(const HsbMapping& later) const;
    bool operator==(const HsbMapping&) const = default;
};
template <>
std::span<const Setting> settingsOf<HsbMapping>();

/// A height field under the volume.
struct GroundView {
    std::string path; ///< a volume file of one layer, or raw with `raw`, or a sample; empty: none
    std::optional<RawLayout> raw;
    std::optional<double> missing;
    std::optional<double> scale; ///< world units per unit of height; empty: as readGround() says
    std::string colorMap = "terrain";
    double relief = 1; ///< strength of the shading
    bool shown = true;
    bool operator==(const GroundView&) const = default;
};
template <>
std::span<const Setting> settingsOf<GroundView>();

/// A second volume over the first (docs/method.md, "The overlay"): where it comes from, and how it is drawn.
struct OverlayView {
    enum class Sides {
        Auto, ///< as the values are
        One,  ///< from a threshold on
        Two   ///< both signs, from a threshold away from 0
    };
    VolumeSource source; ///< `path` empty: none
    bool shown = true;
    Sides sides = Sides::Auto;
    std::optional<double> threshold;   ///< value up to which nothing is drawn; empty: as the values are
    std::optional<double> top;         ///< value that the colours reach to; empty: likewise
    std::string colorMap = kAutomatic; ///< a colour map, or as the values are
    std::optional<double> opacity;     ///< of a path of d0 of the first volume, at `top`; empty: kUsual, or the curve's
    /// In the place of threshold, top and colours; its opacities reach to `opacity`. Without a range of its own it is
    /// over all values.
    std::optional<TransferFunction> curve;

    static constexpr const char* kAutomatic = "auto";
    static constexpr double kUsual = 0.1;
    bool isNone() const { return source.path.empty(); }
    bool isDrawn() const { return !isNone() && shown; }
    bool operator==(const OverlayView&) const = default;
};
template <>
std::span<const Setting> settingsOf<OverlayView>();
template <>
inline constexpr auto kNamesOf<OverlayView::Sides> = enumNames("sides", "auto", "one", "two");

/// Targets at key frames, halfway between them in between; before the first and after the last, those of these.
using TargetKeys = std::map<int, std::map<FeatureId, double>>;

inline constexpr double kLargestTarget = 1e9; ///< only proportions count
inline constexpr double kLargestScale = 1e9;  ///< of HsbMapping

/// Targets of `frame`; keys are not empty. Features that one of the two keys around it does not know have those of the
/// other.
std::map<FeatureId, double> targetsBetween(const TargetKeys& keys, int frame);

/// What belongs to a feature, wherever its interval goes.
struct FeatureGoal {
    double target = 0;              ///< wanted share of saliency, [0, 1e9]; shares are scaled to sum 1 over a TF
    bool locked = false;            ///< an optimization leaves its opacity alone
    double lowest = 0, highest = 1; ///< bounds of its opacity, 0 ≤ lowest ≤ highest ≤ 1
    bool targetLocked = false;      ///< its target stays where those of other features are set

    /// What the feature was when it left the transfer function, by which it is known again; empty: it never left.
    struct Departed {
        std::string name;
        double a = 0, b = 1;
        bool operator==(const Departed&) const = default;
    };
    std::optional<Departed> departed = {};
    bool operator==(const FeatureGoal&) const = default;
};

/// Goals of all features that the session has seen: one that comes back (an undo, a preset) finds its own.
using FeatureGoals = std::map<FeatureId, FeatureGoal>;

/// How the picture looks. No figure depends on it.
struct DisplaySettings {
    RenderMode mode = RenderMode::Composite;
    Light light;
    Rgb background{0, 0, 0};
    std::optional<Rgb> backgroundTop; ///< at the top of the picture; empty: `background` everywhere
    FeatureId onlyFeature = 0;        ///< draw the voxels of this feature alone; 0: all
    double finestStep = 1.0 / 16;     ///< RenderSettings::finestInD0: from the usual step on, no refining
    bool operator==(const DisplaySettings&) const = default;
};
template <>
std::span<const Setting> settingsOf<DisplaySettings>(); ///< beside those of the light

/// How figures are computed.
struct MeasureSettings {
    SaliencyOptions saliency; ///< σ, kernel, w1, w2, background
    VwsOptions vws;           ///< u1, u2
    Quality quality = Quality::Normal;
    EngineChoice engine = EngineChoice::Auto;
    Profile profile = Profile::Default;
    Along along = Along::Front; ///< of the published profile, which looks along an axis of the grid
    bool operator==(const MeasureSettings&) const = default;
};
template <>
std::span<const Setting> settingsOf<MeasureSettings>(); ///< beside those of its parts

/// How opacities are refined by entropy (docs/method.md, "Entropy refinement"), and what is favoured: one intensity,
/// one hue, the colours in a region of the picture, or (all empty) nothing. At most one of the three is set.
struct RefineSettings : RefineSteps {
    bool live = false;                      ///< after every edit, not only when asked for
    std::optional<double> intensity = {};   ///< [0,1]
    std::optional<double> hue = {};         ///< degrees, any real
    std::optional<ImageRegion> region = {}; ///< of the picture as the view shows it
    /// Pixels of the picture that the region's colours are of, width and height; 0: not known.
    std::array<int, 2> regionSize = {0, 0};
    RefineOptions options() const { return {*this, {}, true, {}, {}}; } ///< without what is favoured
    bool favoursAny() const { return intensity || hue || region; }
    void favourNothing() {
        intensity.reset();
        hue.reset();
        region.reset();
        regionSize = {0, 0};
    }
    bool operator==(const RefineSettings&) const = default;
};
template <>
std::span<const Setting> settingsOf<RefineSettings>(); ///< beside RefineSteps

/// Slices beside the picture. No figure depends on them.
struct SliceViews {
    enum class Layout { Volume, Four, VolumeLarge }; ///< the volume alone; four of a size; the volume and three small
    Layout layout = Layout::Volume;
    std::optional<Vec3> crosshair = {};    ///< voxel coordinates, where the three meet; empty: the middle
    std::optional<ValueRange> window = {}; ///< data units of black and white; empty: the variable's window
    double tfStrength = 0.5;               ///< 0: grey alone; 1: the colours of the transfer function alone
    bool operator==(const SliceViews&) const = default;
};
template <>
std::span<const Setting> settingsOf<SliceViews>();
template <>
inline constexpr auto kNamesOf<SliceViews::Layout> = enumNames("layout", "volume", "four", "volume-large");

/// In which coordinates people see and give places. Files and figures stay as they are.
struct CoordinateSettings {
    PatientAxes axes = PatientAxes::Lps;
    bool operator==(const CoordinateSettings&) const = default;
};
template <>
std::span<const Setting> settingsOf<CoordinateSettings>();

/// What of 2D feature saliency the window shows (docs/method.md, "2D feature saliency").
enum class SaliencyMapShown {
    None,
    Picture, ///< S
    Feature, ///< what the selected feature has of S
    Rest     ///< what no feature is drawn at
};
template <>
inline constexpr auto kNamesOf<SaliencyMapShown> = enumNames("saliency map", "none", "picture", "feature", "rest");
struct PictureSaliencyView {
    bool on = false;                               ///< the picture is looked at whenever it rests
    SaliencyMapShown map = SaliencyMapShown::None; ///< laid over the picture, where it is on
    double strength = 0.8;                         ///< opacity of the map where it is largest
    bool operator==(const PictureSaliencyView&) const = default;
};
template <>
std::span<const Setting> settingsOf<PictureSaliencyView>();

/// A state that is kept to be compared with: of what belongs to the data, the present session has the rest.
struct ComparedState {
    std::string name;             ///< what people call it
    Part<TransferFunction> tf;    ///< in its own range
    std::optional<Camera> camera; ///< empty: the home view
    int frame = 0;
    Part<DisplaySettings> display;
    Part<Clipping> clipping;
    bool operator==(const ComparedState&) const = default;
};

/// What the window shows beside the present state A (docs/guide.md, "Comparing"). As camera and crosshair it is no step
/// of the history.
enum class CompareMode { Off, SideBySide, Wipe, Difference };
template <>
inline constexpr auto kNamesOf<CompareMode> = enumNames("comparison", "off", "side-by-side", "wipe", "difference");
struct ComparisonView {
    CompareMode mode = CompareMode::Off;
    bool sameView = true;                ///< B is seen from where A is
    bool sameFrame = true;               ///< of a series
    bool sameLook = true;                ///< in A's light and display, cut as A is
    double divider = 0.5;                ///< of the wipe: share of the width that A has
    double strength = 0.85;              ///< opacity of the difference where it is largest
    std::optional<ComparedState> b = {}; ///< empty: there is nothing to compare with

    bool isOn() const { return b && mode != CompareMode::Off; }
    bool operator==(const ComparisonView&) const = default;
};
template <>
std::span<const Setting> settingsOf<ComparisonView>();

/// A field in the place of the data in the picture, under colours of its own. No figure depends on it.
struct FieldView {
    std::optional<FieldKind> kind;  ///< empty: the data
    FeatureId feature = 0;          ///< of its voxels alone; 0: of all
    std::string colorMap = "ember"; ///< one of colorMaps(), or kFeatureColorMap
    double strength = 0.3;          ///< opacity of a path of d0 at `top`
    double threshold = 0;           ///< of `top`: up to there nothing is drawn
    std::optional<double> top;      ///< value that the colours reach to, in the field's unit; empty: Field::top
    bool operator==(const FieldView&) const = default;
};
template <>
std::span<const Setting> settingsOf<FieldView>();
/// In place of a colour map: from black over the feature's colour to white; of all features, the default map.
inline constexpr const char* kFeatureColorMap = "feature";
/// Throws UsageError where `name` is no colour map and not kFeatureColorMap.
void checkFieldColorMap(const std::string& name);

/// What an optimization began with: enough to do it again with the same data.
struct RunStart {
    TransferFunction tf; ///< as people edit it, in its own range; without points: not known
    Camera camera;
    Clipping clipping;
    MeasureSettings measure;
    OptimizeOptions options;
    std::vector<OpacityLimits> limits; ///< per feature, or empty
    bool operator==(const RunStart&) const = default;
};

/// An optimization or refinement that was run, with what came of it.
struct Run {
    std::string kind;                   ///< "optimize", "refine"
    std::string ended;                  ///< name(StopReason), or "done"
    std::vector<std::string> features;  ///< their names then
    std::vector<double> targets;        ///< shares; of an optimization
    std::vector<OptimizeState> history; ///< of an optimization: the start, then each move
    std::size_t best = 0;               ///< index into history
    double before = 0, after = 0;       ///< F of an optimization, movable energy of a refinement
    int iterations = 0;
    int number = 0;       ///< tells it from the other runs of its session, from 1 on; given by addRun()
    std::string name;     ///< that somebody has given it; empty: none
    std::string started;  ///< local time, ISO 8601 to the second: "2026-11-22T14:03:07"; empty: not known
    double seconds = 0;   ///< of the search; 0: not known
    int evaluations = 0;  ///< of W; 0: not known
    Part<RunStart> start; ///< of an optimization; files of earlier versions do not tell
    bool hasStart() const { return !start->tf.points.empty(); }
    bool operator==(const Run&) const = default;
};
/// The record of an optimization.
Run runOf(const OptimizeResult& result, RunStart start);
/// The answers of `runs` for these targets (shares, one per feature): where another search may begin, since whoever has
/// come near once must not be told that nothing is nearer.
std::vector<std::vector<double>> knownAnswers(const std::vector<Run>& runs, const std::vector<double>& targets);

/// A value: copies share their parts, so that they cost next to nothing, and comparing parts tells what has changed.
struct Session {
    Part<std::vector<Variable>> variables; ///< the first drives opacity; empty: nothing is open
    int frame = 0;                         ///< of the series, from 0
    Part<FeatureGoals> goals;              ///< of the present frame
    Part<TargetKeys> targetKeys;           ///< empty: targets are the same in all frames
    Part<AdaptSettings> adapt;
    Part<HsbMapping> hsb;
    Part<GroundView> ground;
    Part<OverlayView> overlay;
    bool holdTargets = false;      ///< live: opacities follow camera, colours and settings so that targets are held
    std::optional<double> density; ///< where the density slider was left, [0,1] from faint to strong; empty: untouched
    std::optional<Camera> camera;  ///< empty: the home view of the volume
    Part<Clipping> clipping;       ///< what is cut away, of pictures and of figures
    Part<DisplaySettings> display;
    Part<AnnotationChoice> reference; ///< what stands around the picture
    Part<MeasureSettings> measure;
    Part<OptimizeOptions> optimize;
    Part<RefineSettings> refine;
    Part<SliceViews> slices;
    Part<CoordinateSettings> coordinates;
    Part<std::vector<Ruler>> rulers; ///< what people have measured, in the order in which they did
    Part<FieldView> field;           ///< what is drawn in the place of the data
    Part<PictureSaliencyView> pictureSaliency;
    Part<ComparisonView> comparison;
    Part<Keyframes> keyframes;   ///< of a film of these data
    Part<std::vector<Run>> runs; ///< the latest last, at most kMostRuns
    std::string extraJson;       ///< unknown keys of the file it came from, as one JSON object; written back

    bool operator==(const Session&) const = default;

    bool isEmpty() const { return variables->empty(); }
    const Variable& variable() const { return variables->front(); } ///< the one that is drawn; isEmpty() is false
    /// Null where there is no variable of this name.
    const Variable* variableNamed(const std::string& name) const;
    /// The transfer function of this frame, in its own range; null before there is one. Where transfer functions adapt,
    /// the one that was made for the frame, else that of the nearest frame before it back to its key.
    std::shared_ptr<const TransferFunction> tf() const;
    std::shared_ptr<const TransferFunction> tfAt(int frame) const;

    /// Sets the transfer function of this frame; isEmpty() is false. Where there is one key and nothing adapts, it is
    /// that of all frames; else this frame becomes a key. Its features that have no identity yet get
    /// that of a feature with the same name and interval, else the same name, else the same interval; each time of the
    /// present transfer function, else of those that have left it. Else they get a new one.
    void setTf(TransferFunction tf);
    /// Gives the features of all keys that have no identity one, as setTf() does from key to key.
    void identifyFeatures();
    /// Gives the run a number above all others.
    void addRun(Run run);
};

inline constexpr std::size_t kMostRuns = 50;

/// Shares that the features of `tf` are wanted to have, in their order, sum 1: their goals, scaled; those whose target
/// is locked keep theirs as far as the sum is 1. A feature without a goal has the mean of the others; where all are 0
/// or none has one, shares are equal. Empty without features.
std::vector<double> targetsOf(const TransferFunction& tf, const FeatureGoals& goals);
/// The goals after the features of `tf` (which have identities) got `targets`, in their order.
FeatureGoals withTargets(FeatureGoals goals, const TransferFunction& tf, const std::vector<double>& targets);
/// What an optimization may do to the opacities of the features of `tf`, in their order. A hidden feature is locked.
std::vector<OpacityLimits> limitsOf(const TransferFunction& tf, const FeatureGoals& goals);
/// Features of `tf`, in their order, whose share stays where others are set: locked or hidden ones.
std::vector<bool> heldTargets(const TransferFunction& tf, const FeatureGoals& goals);
/// One share set to `value`, as far as those that are `held` (one per feature, or empty: none is) leave room for it;
/// the others divide the rest in their old proportion. As it is where nobody else could give way.
std::vector<double> withTarget(std::vector<double> targets, std::size_t feature, double value,
                               const std::vector<bool>& held = {});
/// The goals after the target of one feature was locked or let go: shares are what they were.
FeatureGoals withTargetLocked(FeatureGoals goals, const TransferFunction& tf, std::size_t feature, bool locked);

} // namespace pellucid
