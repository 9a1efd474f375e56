// What people measure in the window: distances, angles, spheres and boxes, set point by point and kept in the session.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include <QObject>
#include <QPointF>
#include <QSizeF>

#include "jobs/job.h"
#include "render/ruler_marks.h"
#include "session/scene.h"

namespace pellucid::gui {

class Services;

/// Sets, changes and removes the measures of the session, each as a step of the history, and knows what they say. The
/// values in spheres and boxes are found off the window's thread.
class RulerController : public QObject {
    Q_OBJECT
public:
    explicit RulerController(Services& services);

    void addActions();

    /// What is known of the present measures, in the present frame. While a hand changes a sphere or box, it still has
    /// what was found last.
    RulerReadings readings() const;
    /// With units; "…" where it is being found.
    QString textOf(const Ruler& ruler) const;
    QString labelOf(const Ruler& ruler) const; ///< as in the picture
    /// Those that are drawn; the selected one and the one that is being set are marked. Empty where people hide them.
    std::vector<ShownRuler> shown() const;
    std::vector<Ruler> draggable() const; ///< of these, those that a hand may take hold of
    bool isBusy() const { return m_job.isRunning(); }

    // One that is being set:

    void begin(RulerKind kind); ///< the next clicks, in the picture or a slice, are its points
    void giveUp();
    std::optional<RulerKind> placing() const { return m_placing; }
    QString hint() const; ///< what to click on next; empty where nothing is being set
    /// Where the centre of a sphere or box has been set already: the next click says how large it is, wherever it is.
    std::optional<Vec3> center() const;
    void addPoint(const Vec3& world);
    /// Where the mouse is, so that what would come of a click is drawn; empty: nowhere.
    void pointAt(const std::optional<Vec3>& world);

    /// What is seen under a point of a picture of `size`, logical pixels, world; empty where nothing is.
    std::optional<Vec3> seenAt(const Camera& camera, const QPointF& point, const QSizeF& size) const;
    void sayNothingSeen();

    int selected() const { return m_selected; } ///< a number; 0: none
    void select(int number);
    const Ruler* find(int number) const; ///< null: it is not there
    void preview(const Ruler& changed);  ///< while a hand drags it; commit() or cancel() of the store end that
    void remove(int number);
    void rename(int number, const QString& name);
    void setShown(int number, bool shown);

    void chooseFile();
    bool
    exportTo(const QString& path); ///< all of them, as a table; false: it could not be written, as people were told

Q_SIGNALS:
    void changed(); ///< measures, what they say, selection, or what is being set
    void placingChanged();
    void busyChanged();

private:
    struct Known {
        Ruler ruler;
        std::shared_ptr<const Volume> data;
        RulerReading reading;
    };
    struct Task {
        std::vector<Ruler> rulers;
        std::shared_ptr<const Volume> data;
    };
    void follow(const Scene& before, const Scene& after);
    using Words = std::string (*)(const RulerReading& reading, const Geometry& geometry, double span);
    QString said(const Ruler& ruler, Words words) const;
    void findMissing();
    bool isKnown(const Ruler& ruler) const;
    std::optional<Ruler>
    unfinished(const Vec3& next) const; ///< with one point more; empty where that is no measure yet
    void edit(const QString& text, int number, const std::function<void(Ruler&)>& change);

    Services& m_services;
    std::map<int, Known> m_known; ///< by number
    std::optional<RulerKind> m_placing;
    std::vector<Vec3> m_points; ///< of what is being set
    std::optional<Vec3> m_pointer;
    int m_selected = 0;
    Job<Task, RulerReadings> m_job;
};

} // namespace pellucid::gui
