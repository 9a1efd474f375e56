// The panel of presets: transfer functions as small pictures of the volume that is open.
#pragma once

#include <vector>

#include <QWidget>

#include "jobs/job.h"
#include "jobs/rest_timer.h"
#include "session/scene.h"
#include "tf/presets.h"
#include "widgets/kept_renderer.h"

class QComboBox;
class QListWidget;
class QListWidgetItem;
class QToolButton;

namespace pellucid::gui {

class Services;

/// What comes with the program, the thesis's own, and what people have kept, each drawn with the present camera. Own
/// presets are files of the folder presetFolder().
class GalleryPanel : public QWidget {
    Q_OBJECT
public:
    explicit GalleryPanel(Services& services, QWidget* parent = nullptr);

    static QString presetFolder();
    /// Pictures are drawn while the panel can be seen, and then only.
    void setShown(bool shown);

private:
    struct Entry {
        TfPreset preset;
        QString path; ///< of a preset of one's own; empty: it came with the program
    };
    struct Task {
        PictureInput picture;
        std::vector<TransferFunction> tfs;
        int number = 0;
    };

    const Entry* entryAt(int row) const; ///< of the list; null: there is none
    void follow(const Scene& before, const Scene& after);
    void fill();
    void drawSoon();
    void draw();
    void showPicture(int number, int row, const QImage& image);
    void apply(int row);
    void keep();
    void remove();
    void showMenu(const QPoint& at);

    Services& m_services;
    QComboBox *m_group, *m_take;
    QListWidget* m_list;
    QToolButton *m_keep, *m_remove;
    std::vector<Entry> m_entries; ///< in the list's order
    RestTimer m_wait;
    bool m_shown = false, m_stale = true;
    int m_number = 0;
    std::shared_ptr<KeptRenderer> m_renderer;
    Job<Task, int> m_job; ///< last: it ends before the rest goes
};

} // namespace pellucid::gui
