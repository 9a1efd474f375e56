#include "session/adapt_tasks.h"

#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "base/digest.h"
#include "session/scene.h"
#include "session/scene_data.h"
#include "session/session_json.h"

namespace pellucid {

namespace {

using Mode = AdaptSettings::Mode;

class Hash : public Digest {
public:
    using Digest::add;
    void add(const Rgb& color) { addAll(color.r, color.g, color.b); }
    void add(const ValueRange& range) { addAll(range.lo, range.hi); }
    template <class... Values>
    void addAll(const Values&... values) {
        (add(values), ...);
    }
};

void addSource(Hash& hash, const VolumeSource& source) {
    namespace fs = std::filesystem;
    const auto addFile = [&](const std::string& path) {
        hash.add(source.isSample() ? path : fs::path(path).filename().string());
        std::error_code none;
        hash.add(fs::is_regular_file(path, none) ? static_cast<long long>(fs::file_size(path, none)) : -1LL);
    };
    addFile(source.path);
    for (const std::string& path : source.more) addFile(path);
    hash.addAll(source.step, source.array);
    if (source.raw) {
        const RawLayout& raw = *source.raw;
        const GridSpacing spacing = source.spacing.value_or(GridSpacing());
        hash.addAll(raw.dims.x, raw.dims.y, raw.dims.z, static_cast<int>(raw.type), raw.bigEndian, raw.skipBytes,
                    spacing.distances.x, spacing.distances.y, spacing.distances.z);
    }
    hash.addAll(source.missing.value_or(std::nan("")), source.component, source.sampleSize,
                static_cast<int>(source.seed), source.downsample);
    if (source.axes) hash.add(gridAxesText(*source.axes));
    if (source.spacing && (!source.raw || source.spacing->unit != LengthUnit::Unknown))
        hash.add(gridSpacingText(*source.spacing));
    if (source.region)
        for (int a = 0; a < 3; ++a) hash.addAll(source.region->lo[a], source.region->hi[a]);
}

void addTf(Hash& hash, const TransferFunction& tf) {
    hash.add(tf.points.size());
    for (const ControlPoint& p : tf.points) hash.addAll(p.x, p.opacity, p.color, p.fixed);
    hash.add(tf.features.size());
    for (const Feature& f : tf.features) hash.addAll(f.name, f.a, f.b, f.color, f.hidden, f.id);
    if (tf.range) hash.add(*tf.range);
}

/// How a variable is made, down to the plain one; empty: it is that. A damaged file may have an endless one.
std::string originOf(const Session& session, const Variable& variable) {
    std::string text;
    const Variable* made = &variable;
    for (int depth = 0; depth < 100 && made != nullptr && made->derivation; ++depth) {
        text += (depth > 0 ? " of " : "") + made->derivation->text();
        made = session.variableNamed(made->derivation->of);
    }
    return text;
}

/// Fingerprints of one session: what its frames have in common is hashed once.
class Fingerprints {
public:
    Fingerprints(const Session& session, const TimeSeries& series) : m_session(session), m_series(series) {
        const Mode mode = session.adapt->mode;
        Session common; // nothing but what counts
        common.adapt = session.adapt;
        common.adapt.edit([](AdaptSettings& a) { a.coherence = a.usedCoherence(); });
        const bool viewed = mode == Mode::Optimize || (mode == Mode::Refine && session.refine->region);
        if (mode == Mode::Refine) {
            common.refine = session.refine;
            common.refine.edit([](RefineSettings& r) { r.live = false; });
            common.measure.edit([&](MeasureSettings& m) { m.profile = session.measure->profile; });
        }
        if (viewed) {
            common.camera = session.camera;
            common.clipping = session.clipping;
        }
        if (mode == Mode::Optimize) {
            common.measure = session.measure;
            common.optimize = session.optimize;
        }
        const bool hued = mode == Mode::Refine && session.refine->hue;
        const bool coloured = (viewed || hued) && session.hsb->on; // what is measured, what a region or a hue shows
        if (coloured) common.hsb = session.hsb;
        m_common.add(jsonFromSession(common, "", DataPaths::Absolute).dump());
        const std::size_t variables = coloured ? session.variables->size() : 1;
        for (std::size_t i = 0; i < variables; ++i) {
            const Variable& v = (*session.variables)[i];
            m_common.add(originOf(session, v));
            if (v.window) m_common.add(*v.window);
            if (i > 0 || v.derivation) { // of the first one, plain, frame by frame
                m_common.add(v.name);
                addSource(m_common, v.source);
            }
        }
        // Without a window of its own it is that of all frames; what is derived may be made of several.
        const bool others = variables > 1 || session.variable().derivation.has_value();
        if (!session.variable().window || others)
            for (const SeriesFrame& frame : series.listing().frames) addSource(m_common, frame.source);
        m_needsKey = mode == Mode::Refine && (session.refine->region || session.refine->hue);
    }

    std::string of(int frame, const TransferFunction& previous) const {
        Hash hash = m_common;
        addSource(hash, m_series.listing().frames[static_cast<std::size_t>(frame)].source);
        if (m_session.hsb->on) hash.add(frame);
        addTf(hash, previous);
        const TfTrack& track = m_session.variable().track;
        if (const int key = track.keyBefore(frame); m_needsKey && key >= 0) {
            addTf(hash, *track.keys.at(key));
            addSource(hash, m_series.listing().frames[static_cast<std::size_t>(m_series.nearest(key))].source);
        }
        if (m_session.adapt->mode == Mode::Optimize) {
            const FeatureGoals goals = frame == m_session.frame ? *m_session.goals : goalsAt(m_session, frame);
            for (const double t : targetsOf(previous, goals)) hash.add(t);
            for (const OpacityLimits& limit : limitsOf(previous, goals))
                hash.addAll(limit.lowest, limit.highest, limit.locked);
        }
        return hash.text();
    }

private:
    const Session& m_session;
    const TimeSeries& m_series;
    Hash m_common;
    bool m_needsKey = false;
};

/// Calls `visit(task, isFresh)` for the frames that should have an adapted transfer function, in the order of
/// nextToAdapt(), until it returns false. A frame after a stale one has nothing to start from: its task is empty.
template <class Visit>
void visitFrames(const Session& session, const TimeSeries& series, const Visit& visit) {
    if (session.isEmpty() || session.adapt->mode == Mode::Static) return;
    const TfTrack& track = session.variable().track;
    if (track.keys.empty()) return;
    const Fingerprints fingerprints(session, series);
    std::vector<int> keys;
    const int present = track.keyBefore(session.frame);
    keys.push_back(present);
    for (const auto& [key, tf] : track.keys)
        if (key != present) keys.push_back(key);
    for (const int key : keys) {
        const auto next = track.keys.upper_bound(key);
        const int end = next == track.keys.end() ? series.size() : std::min(next->first, series.size());
        std::shared_ptr<const TransferFunction> previous = track.keys.at(key).shared();
        for (int frame = key; frame < end; ++frame) {
            if (!series.summary(frame).problem.empty()) continue;
            std::optional<AdaptTask> task;
            bool fresh = false;
            if (previous) {
                task = AdaptTask{frame, key, *previous, fingerprints.of(frame, *previous)};
                const auto there = track.adapted.find(frame);
                fresh = there != track.adapted.end() && there->second.basis == task->basis;
                previous = fresh ? there->second.tf.shared() : nullptr;
            }
            if (!visit(task, fresh)) return;
        }
    }
}

/// Frames from one key to the next.
struct Stretch {
    SmoothTask task;
    int all = 0, done = 0; ///< frames that should have a transfer function, and have one
    bool isSmooth = true;  ///< what was smoothed is of the present ones
};

/// In the order of nextToAdapt().
std::vector<Stretch> stretchesOf(const Session& session, const TimeSeries& series) {
    std::vector<Stretch> stretches;
    std::vector<std::vector<std::string>> bases;
    visitFrames(session, series, [&](const std::optional<AdaptTask>& task, bool fresh) {
        if (task && (stretches.empty() || stretches.back().task.key != task->key)) {
            stretches.emplace_back().task.key = task->key;
            bases.emplace_back();
        }
        Stretch& stretch = stretches.back(); // the first frame from a key on has a task
        ++stretch.all;
        if (!fresh) return true;
        ++stretch.done;
        stretch.task.frames.push_back(task->frame);
        bases.back().push_back(task->basis);
        return true;
    });
    if (!smooths(*session.adapt)) return stretches;
    const TfTrack& track = session.variable().track;
    for (std::size_t i = 0; i < stretches.size(); ++i) {
        Stretch& stretch = stretches[i];
        if (stretch.done < stretch.all) {
            stretch.isSmooth = false;
            continue;
        }
        Hash hash;
        for (const std::string& basis : bases[i]) hash.add(basis);
        addTf(hash, *track.adapted.at(stretch.task.frames.back()).tf); // those before it are in the next one's basis
        if (const auto next = track.keys.upper_bound(stretch.task.key); next != track.keys.end())
            addTf(hash, startAtKey(track, next->first));
        stretch.task.basis = hash.text();
        if (session.adapt->mode == Mode::Optimize && track.keys.at(stretch.task.key)->features.empty())
            continue; // nothing was optimized
        for (const int frame : stretch.task.frames)
            stretch.isSmooth = stretch.isSmooth && track.adapted.at(frame).smooth &&
                               track.adapted.at(frame).smoothBasis == stretch.task.basis;
    }
    return stretches;
}

} // namespace

bool smooths(const AdaptSettings& settings) {
    return settings.mode != Mode::Static && settings.usedCoherence() > 0 && !std::isinf(settings.usedCoherence());
}

std::string frameFingerprint(const Session& session, const TimeSeries& series, int frame,
                             const TransferFunction& previous) {
    return Fingerprints(session, series).of(frame, previous);
}

std::optional<AdaptTask> nextToAdapt(const Session& session, const TimeSeries& series) {
    std::optional<AdaptTask> next;
    visitFrames(session, series, [&](std::optional<AdaptTask>& task, bool fresh) {
        if (fresh || !task) return true;
        next = std::move(task);
        return false;
    });
    return next;
}

int firstStale(const Session& session, const TimeSeries& series) {
    const auto next = nextToAdapt(session, series);
    return next ? next->frame : -1;
}

AdaptProgress adaptProgress(const Session& session, const TimeSeries& series) {
    AdaptProgress progress;
    for (const Stretch& stretch : stretchesOf(session, series)) {
        progress.all += stretch.all;
        progress.done += stretch.done;
        progress.smooth += stretch.isSmooth ? stretch.all : 0;
    }
    return progress;
}

std::optional<SmoothTask> nextToSmooth(const Session& session, const TimeSeries& series) {
    if (!smooths(*session.adapt)) return {};
    for (Stretch& stretch : stretchesOf(session, series))
        if (stretch.done == stretch.all && !stretch.isSmooth) return std::move(stretch.task);
    return {};
}

const TransferFunction& startAtKey(const TfTrack& track, int key) {
    const auto made = track.adapted.find(key);
    return made == track.adapted.end() ? *track.keys.at(key) : *made->second.tf;
}

std::string fingerprintWith(const TransferFunction& tf, const std::string& basis) {
    Hash hash;
    hash.add(basis);
    addTf(hash, tf);
    return hash.text();
}

} // namespace pellucid
