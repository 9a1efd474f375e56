// Fields in the place of the data: computed off the window's thread, drawn by whoever draws the picture.
#pragma once

#include <optional>

#include <QObject>

#include "jobs/job.h"
#include "jobs/rest_timer.h"
#include "session/workspace.h"

namespace pellucid::gui {

class Services;

/// Computes the field that the session asks for as soon as the scene rests, and decides whether the data or the field
/// is drawn. A field belongs to the state that it was computed from; when that is no longer the present state, the
/// field is still drawn, under a title that says so.
class FieldController : public QObject {
    Q_OBJECT
public:
    enum class State {
        Off,       ///< the data are drawn
        Computing, ///< also while it waits for the scene to rest
        Current,
        Stopped, ///< by the user; the next change, or compute(), goes on
        Failed   ///< failure() tells why
    };

    explicit FieldController(Services& services);

    void addActions();

    State state() const { return m_state; }
    /// What is drawn, of an older state unless current; null: the data are.
    const Field* field() const { return m_state == State::Off || !m_field ? nullptr : &*m_field; }
    const std::optional<Error>& failure() const { return m_failure; }
    /// Of the field that is drawn or wanted: "Visibility, f2"; empty while the data are.
    QString name() const;
    /// That what is drawn is no field of the present state, and why: "of an earlier state; the present one: stopped";
    /// empty where it is one, and while the data are drawn.
    QString stateText() const;
    /// A value of field(), with its kind and unit: "Visibility 0.42 (0 to 1)".
    QString valueText(double value) const;
    double progress() const { return m_progress; } ///< of what is being computed, [0,1]
    bool isBusy() const { return m_state == State::Computing || m_saving.isRunning(); }

    /// What the view shows, in this size; the store has a volume.
    PictureInput picture(int width, int height, bool transparent = false) const;
    /// What stands around such a picture. A field always has its title and legend.
    AnnotationInput annotation(const PictureInput& picture, const AnnotationChoice& show, double density = 1) const;

    void show(std::optional<FieldKind> kind); ///< an edit
    void compute();                           ///< after it was stopped or has failed
    void cancel();
    void save(const QString& path); ///< of a current field, as NRRD, float32; in the background
    void chooseFile();

Q_SIGNALS:
    void changed(); ///< what is drawn, state or progress
    void busyChanged();
    void saved(const QString& path);

private:
    struct Request {
        MeasureInput input; ///< what the field does not depend on is the same in all
        FieldKind kind = FieldKind::Visibility;
        int feature = -1;
        bool operator==(const Request&) const = default;
    };
    struct Made {
        Field field;
        std::shared_ptr<const IntensityGrid> codes; ///< of its volume, for those who draw it
    };
    struct File {
        std::shared_ptr<const Volume> volume;
        QString path;
    };
    static Request requestOf(const Scene& scene);
    void follow(const Scene& before, const Scene& after);
    void setState(State state);

    Services& m_services;
    State m_state = State::Off;
    std::optional<Field> m_field;
    std::shared_ptr<const IntensityGrid> m_codes;
    Request m_wanted, m_shown; ///< m_shown: of m_field
    FieldKind m_lastKind = FieldKind::Vws;
    std::optional<Error> m_failure;
    double m_progress = 0;
    /// Milliseconds without a change before a field is computed.
    RestTimer m_rest{150,
                     [this] { m_computing.start(m_wanted, QString::fromStdString(m_wanted.input.volume->title)); }};
    Job<Request, Made> m_computing;
    Job<File, QString> m_saving;
};

} // namespace pellucid::gui
