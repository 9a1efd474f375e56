// From what a user named to what can be drawn and measured: the one way, for the window, the command line and tests.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "optimize/answer/first_sight.h"
#include "render/annotation.h"
#include "render/ground.h"
#include "render/standard_view.h"
#include "session/overlay_file.h"
#include "session/session.h"
#include "tf/empty_features.h"
#include "tf/proposal.h"
#include "volume/histogram.h"
#include "volume/intensity_grid.h"
#include "volume/time_series.h"
#include "volume/voxel_colors.h"

namespace pellucid {

/// A session together with the data that it speaks of. Immutable parts are shared: copies are cheap. The parts belong
/// together: who wants another session changes a copy of this one and has it resolved.
struct Scene {
    Session session;
    std::shared_ptr<const Volume> data;         ///< as read, in the range of its values; null where nothing is open
    std::shared_ptr<const Volume> volume;       ///< the same through the variable's window
    TransferFunction tf;                        ///< of the present frame, written for the window
    Camera camera;                              ///< the session's, else the home view
    std::shared_ptr<const Histogram> histogram; ///< 256 bins of `volume`; null likewise
    std::shared_ptr<const IntensityGrid> codes; ///< of `volume`, kept for those who draw and measure; null before
                                                ///< prepareToShow()
    std::optional<std::string> unit;            ///< of the data: "HU", "" where unknown; empty before prepareToShow()
    std::shared_ptr<TimeSeries> series;         ///< of the variable that is drawn, one frame or many; null like `data`
    /// Of the other variables that channels name, and of those that derived ones are made of, by their names.
    std::map<std::string, std::shared_ptr<TimeSeries>> others;
    std::shared_ptr<const VoxelColors> colors;   ///< of HsbMapping, of this frame; null: those of the transfer function
    double hsbA = 1, hsbB = 1;                   ///< scales that `colors` were made with
    std::shared_ptr<const Ground> ground;        ///< null: none
    std::shared_ptr<const SceneOverlay> overlay; ///< null: none
    std::shared_ptr<const Proposal> proposal; ///< where this resolving proposed window and transfer function; else null

    /// `tf` for all that has to do with targets: features without a voxel in this frame are hidden, too.
    TransferFunction wantedTf() const { return histogram ? withEmptyHidden(tf, *histogram) : tf; }
    /// Wanted shares of the features, in their order; 0 of hidden and of empty ones.
    std::vector<double> targets() const { return targetsOf(wantedTf(), *session.goals); }
    /// Whether the frame has no voxel of this feature, an index in tf.features.
    bool isEmpty(std::size_t feature) const { return histogram && !hasVoxel(tf.features.at(feature), *histogram); }
    /// Index in tf.features of the feature that is drawn alone; −1: all are.
    int onlyFeature() const;
    /// Index of the feature whose field is drawn, −1: of all.
    int fieldFeature() const;
};

/// In place of a transfer function: what the data themselves propose (docs/method.md, "The automatic start").
inline constexpr const char* kAutomaticTf = "auto";

/// What a user may name beside a session, or in place of one. Everything given overrides the session.
struct SceneInputs {
    std::optional<int> frame;        ///< of the series, from 0; in place of the session's
    Session session;                 ///< what to start from: its variable's source is what is opened
    std::optional<std::string> tf;   ///< a file, tents:N[:PEAK], ramp:N, preset:NAME or kAutomaticTf
    std::optional<ValueRange> range; ///< intensity window, data units
    std::optional<Camera> camera;
    std::string cameraName;               ///< of `camera` in messages, such as its file
    std::optional<ViewAngles> view;       ///< in place of `camera`, see cameraFromView()
    std::optional<NamedView> namedView;   ///< in place of both
    std::optional<Projection> projection; ///< of `view`, else of the session's camera, else of the home view
    MemoryUse then;                       ///< what is done with the volume, see VolumeSource
    /// What a volume without transfer function gets: the automatic start; the same before its opacities are tuned, for
    /// those who show it first (see tunedStart()); or tents:3 over all values, for those who need none.
    enum class Start { Tuned, Proposed, Tents } start = Start::Tuned;
    /// With an automatic start what the object lies on is made faint; or it is this dense, [0, 1]: 0 leaves it out, 1
    /// leaves it as it is.
    std::optional<double> holder;
};

/// From where the inputs look at a volume: `namedView`, else `camera`, else `view`, else the session's camera, else the
/// home view. Throws Error where that is inside its box.
Camera cameraOf(const SceneInputs& inputs, const Geometry& geometry);

/// In the published profile an intensity of 8-bit data is value/255: a transfer function that says of no values is of
/// 0 to 255 there. Elsewhere `tf` stays as it is.
void placeAsPublished(const Session& session, const Volume& data, TransferFunction& tf);

/// Opens everything. The intensity window is `range`, else that of the named transfer-function file, else the
/// session's (unless kAutomaticTf is asked for), else what the data propose where the transfer function comes from them
/// too, else as placeAsPublished() says, else the range of the values. A transfer function keeps its data values
/// whatever the window is. Throws FileError, Error (a camera inside the box), UsageError (no source), Cancelled.
Scene openScene(const SceneInputs& inputs, const JobControl& job = {});

/// The transfer function of a scene that has a proposal, with opacities for the home view, whatever its camera is: a
/// volume has one automatic start. Throws Cancelled.
FirstSight tunedStart(const Scene& scene, const JobControl& job = {});
/// Puts a start into a session: its transfer function, the shares that it aims at as targets, where none of its
/// features has one, and what the object lies on.
void setStart(Session& session, const FirstSight& start);

/// The automatic start of a scene's data, whatever its window and transfer function are.
struct AutomaticStart {
    Proposal proposal;
    std::optional<ValueRange> window; ///< as Variable::window
    FirstSight sight;                 ///< from the view that was asked for
};
/// Throws Cancelled.
AutomaticStart automaticStart(const Scene& scene, const View& view, const JobControl& job = {});

/// The scene of a session; a session without transfer function gets what the data propose, not tuned. Data that `basis`
/// has is taken from there: where source, frame and window are the same this costs next to nothing, where only the
/// window differs no file is read. A frame beyond the end becomes the last one. Targets of another frame than that of
/// `basis` are those of the session's target keys; other targets in the same frame become its key, where there are
/// keys. `histogram`: of the frame through its window, where it is known and `basis` has none.
Scene resolve(Session session, const Scene& basis, const MemoryUse& then = {}, const JobControl& job = {},
              const std::shared_ptr<const Histogram>& histogram = {});
/// Whether resolve() would read a file or go over all voxels. Colours of several variables are no reason: where they
/// are to be made anew for a change at hand, that is done at once.
bool needsData(const Session& session, const Scene& basis);

/// Makes what a window needs of the volume besides: all that takes time, off its thread.
void prepareToShow(Scene& scene, const JobControl& job = {});

/// Source of the variable and nothing else: a session in which nothing has been decided yet.
Session sessionOf(const VolumeSource& source);

/// Everything that figures depend on: equal inputs have equal figures.
struct MeasureInput {
    std::shared_ptr<const Volume> volume;
    TransferFunction tf;
    View view;
    MeasureSettings settings;
    std::shared_ptr<const VoxelColors> colors; ///< null: those of the transfer function
    bool operator==(const MeasureInput&) const = default;
};
/// Of the published profile the view is that of its axis (cameraAlong()), wherever the camera is, and what the profile
/// does not depend on is as by default.
MeasureInput measureInput(const Scene& scene);
/// What an optimization of the scene under `options` begins with.
RunStart runStartOf(const Scene& scene, const OptimizeOptions& options);

/// What the field that the session shows depends on; what it does not, is the same in all.
MeasureInput fieldInput(const Scene& scene);

/// Everything that a picture depends on.
struct PictureInput {
    std::shared_ptr<const Volume> volume; ///< null: nothing but the background
    TransferFunction tf;
    Camera camera;
    RenderSettings settings; ///< size, background, step, light, clipping, feature
    bool operator==(const PictureInput&) const = default;
};
/// Samples at half of d0 (quality high: a quarter). `transparent`: without the background.
PictureInput pictureInput(const Scene& scene, int width, int height, bool transparent = false);

/// A field in the place of the data: its values under the colours of the session's FieldView, in the same view, by
/// emission and absorption and without light.
PictureInput fieldPictureInput(const Scene& scene, const Field& field, int width, int height, bool transparent = false);
/// What a field is drawn as over intensities 0 … 1, which are the values 0 … topOf(): colours of the map, opacity 0 up
/// to the threshold and rising evenly to the strength. `features`: those that FieldView::feature is one of.
TransferFunction fieldTf(const FieldView& view, std::span<const Feature> features);
/// The same for a slice, where colours alone tell: opaque wherever something is drawn.
TransferFunction fieldSliceTf(TransferFunction tf);
/// The value that the colours reach to.
double topOf(const FieldView& view, const Field& field);

/// The same with the colours of the transfer function alone: no light, no background, no single feature. What a region
/// is made of that someone draws in the picture (regionColors()).
PictureInput plainPictureInput(const Scene& scene, int width, int height);

/// What the measures of a session say, by their numbers.
using RulerReadings = std::map<int, RulerReading>;
/// Throws Cancelled.
RulerReadings readRulers(const std::vector<Ruler>& rulers, const Volume& volume, const JobControl& job = {});
/// Those that are shown, with what they say where that is known; the scene has a volume.
std::vector<ShownRuler> shownRulers(const Scene& scene, const RulerReadings& readings);

/// Everything that what stands around a picture depends on; the picture has a volume. `density`: pixels of the picture
/// in which lengths of the screen are one.
AnnotationInput annotationInput(const PictureInput& picture, const AnnotationChoice& show, double density = 1);
/// Adds what belongs to the session alone: its measures, and the coordinates that people have chosen.
void addMeasures(AnnotationInput& input, const Scene& scene, const RulerReadings& readings);
/// Of a picture of a field: its name and a legend of its colours too, unless `show` switches everything off.
AnnotationInput fieldAnnotationInput(const PictureInput& picture, const Scene& scene, const Field& field,
                                     AnnotationChoice show, double density = 1);

} // namespace pellucid
