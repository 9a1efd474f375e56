// The one place where a session changes: every change can be undone, and everybody hears of it once, when it is whole.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <QObject>
#include <QString>

#include "session/scene.h"

namespace pellucid::gui {

/// Holds the present scene and its history. Lives in the window's thread.
///
/// An edit is one step of the history. A preview (while the mouse is down, while an optimization runs) is none: it
/// shows a change of the committed session until commit() or cancel(). An edit, undo or redo during a preview ends that
/// first: an edit commits it, undo and redo cancel it. The camera has a history of its own, the crosshair of the
/// slices, what is compared and the frame of a series have none: undo never turns the view, nor goes to another frame.
/// An edit that itself exchanges what is compared with takes it along, so that nothing is lost. Steps of a series hold
/// no volumes: they are undone on the frame that is there.
class SessionStore : public QObject {
    Q_OBJECT
public:
    using Change = std::function<void(Session&)>;
    /// What follows of an edit or preview by itself: may alter `session`, which is that of `after`, and says what it
    /// has done to it; empty: nothing.
    using Consequence = std::function<QString(const Scene& before, const Scene& after, Session& session)>;

    explicit SessionStore(QObject* parent = nullptr);

    const Scene& scene() const { return m_scene; }
    const Session& session() const { return m_scene.session; }
    bool hasVolume() const { return m_scene.volume != nullptr; }

    /// Replaces everything; both histories begin anew.
    void open(Scene scene);

    /// One step named `text`. Steps with the same non-empty `mergeKey` in a row become one. No change, no step. The
    /// change must not need other data than there are, see needsData(); with `basis`, than that scene has.
    void edit(const QString& text, const QString& mergeKey, const Change& change, const Scene* basis = nullptr);

    /// Shows `change` of the committed session, whatever was previewed before; the step will be named `text`.
    void preview(const QString& text, const Change& change);
    bool isPreviewing() const { return m_committed.has_value(); }
    /// The scene without the preview.
    const Scene& committed() const { return m_committed ? *m_committed : m_scene; }
    /// Changes the state before the preview, and so every preview of it: undo keeps the change. For records of what was
    /// done, on which nothing that is drawn or computed depends.
    void record(const Change& change);
    void commit(const QString& mergeKey = {});
    void cancel();

    /// A change that follows from the present state by itself, but later. It is shown, and becomes part of the running
    /// preview, else of the latest step; it is no step of its own, and a clean session stays clean. A preview that goes
    /// on applies it again: it must hold no references.
    void amend(const Change& change);

    /// Asked at every edit and preview before anybody hears of it: both are one change and one step, named by both.
    void setConsequence(Consequence consequence) { m_consequence = std::move(consequence); }

    bool canUndo() const { return isPreviewing() || m_index > 0; }
    bool canRedo() const { return m_index < m_steps.size(); }
    QString undoText() const;
    QString redoText() const;
    int stepCount() const { return static_cast<int>(m_steps.size()); } ///< undone ones too
    int doneCount() const { return static_cast<int>(m_index); }        ///< steps that could be undone
    QString textOf(int step) const { return m_steps.at(static_cast<std::size_t>(step)).text; }
    /// The session before a step, 0 ≤ step < stepCount().
    const Session& sessionBefore(int step) const { return m_steps.at(static_cast<std::size_t>(step)).before.session; }
    void undo();
    void redo();

    /// Moves with the same gesture in a row are one step of the camera's history; 0: each is one.
    void setCamera(const Camera& camera, int gesture = 0);
    static int newGesture(); ///< a number that no gesture has had
    bool canUndoCamera() const { return m_cameraIndex > 0; }
    bool canRedoCamera() const { return m_cameraIndex + 1 < m_cameras.size(); }
    void undoCamera();
    void redoCamera();

    /// Where the slices meet, voxel coordinates. It has no history: undo leaves it where it is.
    void setCrosshair(const Vec3& voxel);

    /// What stands beside the present state. It has no history either, and is no change that would be lost.
    void setComparison(const std::function<void(ComparisonView&)>& change);

    /// Goes to the frame of `shown`: a scene of the present series with the data of another frame (resolve() made it
    /// off this thread). All else stays as it is in the present session, a preview under way included; targets follow
    /// their keys. isShownBy() must hold.
    void setFrame(const Scene& shown);
    /// Whether `shown` has all that the present session needs at its frame, so that setFrame() takes no time.
    bool isShownBy(const Scene& shown) const;

    /// Nothing would be lost by closing: the present state is the one that was opened or saved, whatever frame it is at
    /// and whatever has been made for frames by itself.
    bool isClean() const;
    void setClean();
    void setUnsaved(); ///< it has no file, whatever it is compared with
    /// The transfer function alone was saved: clean where nothing else has changed since the state was.
    void setTfSaved();

Q_SIGNALS:
    /// Of every change, the preview's and the camera's too. Both are whole; `after` is scene().
    void changed(const pellucid::Scene& before, const pellucid::Scene& after);
    void historyChanged(); ///< of undo, redo or clean

private:
    struct Step {
        QString text, mergeKey;
        Scene before, after;
        /// Of a step that exchanges what is compared with: undone and done again with it.
        struct Compared {
            std::optional<ComparedState> before, after;
        };
        std::optional<Compared> compared = {};
    };
    void show(Scene next);
    void push(const QString& text, const QString& mergeKey, Scene before, std::optional<Step::Compared> compared = {});
    void forgetOldData();
    void endPreview(const std::function<void(Scene before)>& end);
    void goToCamera(std::size_t index);
    void showCamera(const Camera& camera);
    /// Adds to `text` what followed.
    Scene changedBy(const Change& change, const Scene& from, const Scene& basis, QString& text) const;
    Scene withPresentGaze(Scene scene) const;
    Scene atPresentFrame(Scene scene) const;
    static Scene atFrame(Session session, int frame, Scene basis);
    static Scene movedTo(const Scene& shown, const Scene& from);

    Scene m_scene;
    std::optional<Scene> m_committed; // while previewing
    QString m_previewText;
    Change m_amendment; // of the preview; empty: none
    Consequence m_consequence;
    std::vector<Step> m_steps;
    std::size_t m_index = 0;        // steps that are done
    std::optional<Session> m_clean; // empty: it was never saved
    std::vector<Camera> m_cameras;  // the history; the present one at m_cameraIndex
    std::size_t m_cameraIndex = 0;
    int m_lastGesture = 0;
};

} // namespace pellucid::gui
