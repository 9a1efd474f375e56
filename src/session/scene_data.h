// What resolve() makes of a session beside its first variable: other variables, their colours, the ground, targets.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "session/scene.h"
#include "tf/formats/tf_file.h"

namespace pellucid {

/// The definition of volatility that the session's profile has.
VolatilityKind volatilityKind(const Session& session);

/// Whether both variables have the same values, whatever they are called and seen through.
bool sameOrigin(const Variable& a, const Variable& b);
/// The same variables in the same order through the same windows, whatever their transfer functions are.
bool sameData(const std::vector<Variable>& a, const std::vector<Variable>& b);

/// The files that a session's data are in: those of its variables, of its ground and of its
/// overlay, as filesOf(VolumeSource) says.
std::vector<std::string> filesOf(const Session& session);

/// What is to be said of a transfer function of another program where it is opened in a scene: openingNotices(), and
/// nothing of one that the scene's profile takes as it is.
std::vector<std::string> openingNoticesIn(const Scene& scene, const ReadTf& read);

/// Smallest and largest value of all frames where they are known without reading one, else those of the present frame.
ValueRange dataRangeOf(const Scene& scene);
/// Which frame dataRangeOf() is of, "frame 3"; empty: of all.
std::string frameOfDataRange(const Scene& scene);
/// `tf` for programs that draw the present data: its intensities refer to `window` (empty: the one that the scene is
/// seen through). `path`: the file that it is written to, which names the preset.
TfToWrite toWrite(const TransferFunction& tf, const Scene& scene, const std::string& path,
                  const std::optional<ValueRange>& window = {});
/// A transfer function that has been read for the present data; what spans them (ReadTf::spansData) gets dataRangeOf().
TransferFunction forScene(const ReadTf& read, const Scene& scene);

/// The window of the variable that `series` has the values of: its own, or all values.
ValueRange windowOf(const Variable& variable, TimeSeries& series, const JobControl& job = {});

/// `data` through `window`; empty: as it is.
std::shared_ptr<const Volume> throughWindow(const std::shared_ptr<const Volume>& data,
                                            const std::optional<ValueRange>& window);

/// Finds and makes the series of a scene's variables: those of `basis` where they are the same. All outlive this.
class SeriesFinder {
public:
    SeriesFinder(Scene& scene, const Scene& basis, const MemoryUse& then, const JobControl& job)
        : m_scene(scene), m_basis(basis), m_then(then), m_job(job) {}

    /// Of a variable of the session, or of a derivation of one, by name; kept in Scene::others. Throws UsageError where
    /// there is none.
    std::shared_ptr<TimeSeries> find(const std::string& name);
    std::shared_ptr<TimeSeries> of(const Variable& variable);
    /// Keeps the series of all variables of the session that `basis` knows, drawn with or not.
    void keepKnown();

private:
    bool isKnown(const Variable& variable) const;
    std::shared_ptr<TimeSeries> knownOf(const std::string& name) const;
    std::shared_ptr<TimeSeries> derived(const std::string& name, const Derivation& derivation);
    std::string knownNames() const;

    Scene& m_scene;
    const Scene& m_basis;
    const MemoryUse& m_then;
    const JobControl& m_job;
    std::vector<std::string> m_path; // of derivations, down to the one that is looked for
};

/// Opens the variables that are not in `basis` and reads their present frame, so that faults of files are known at
/// once. Throws as loadVolume() does.
void openNewVariables(Scene& scene, const Scene& basis, const MemoryUse& then, const JobControl& job);

/// The goals with the targets that the session's keys have at a frame; where there are no keys, as they are.
FeatureGoals goalsAt(const Session& session, int frame);

/// Targets of the present frame: from the keys where frame or keys are others than those of `basis`, else into them.
void followTargetKeys(Session& session, const Scene& basis);

/// Scene::colors and their scales; those of `basis` where nothing has changed.
void resolveColors(Scene& scene, const Scene& basis, SeriesFinder& finder, const JobControl& job);

/// Scene::ground, likewise.
void resolveGround(Scene& scene, const Scene& basis, const JobControl& job);

/// Scene::overlay, likewise.
void resolveOverlay(Scene& scene, const Scene& basis, const JobControl& job);

} // namespace pellucid
