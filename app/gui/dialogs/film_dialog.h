// What a film shows, how long and how large it is, and where it goes.
#pragma once

#include <optional>

#include <QDialog>
#include <QSize>

#include "film/film.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QLineEdit;
class QSpinBox;

namespace pellucid::gui {

struct FilmOptions {
    FilmSettings settings;
    QString views; ///< as viewsOfText() reads them
    QSize size;
    bool annotated = false;
    QString path;
};

class FilmDialog : public QDialog {
    Q_OBJECT
public:
    /// `seen`: pixels of the view, the size that is offered first; `series`: pictures of a film of all frames, 0: there
    /// is no series; `keys`: seconds from the first key to the last, empty: there are none; `annotated`: whether
    /// annotations are shown.
    FilmDialog(const FilmOptions& offered, const QSize& seen, int series, std::optional<double> keys, bool annotated,
               QWidget* parent = nullptr);
    FilmOptions options() const;

    /// As words that options() has then: the view that the window has, such as "30,20,1.5".
    void setPresentView(const QString& view) { m_present = view; }

private:
    QDoubleSpinBox* numberBox(const char* key, double FilmSettings::*member, const QString& id, int decimals);
    void makeSizes(const QSize& seen);
    void addPresentView();
    void browse();
    void follow();

    double pictures(const FilmSettings& settings) const; ///< how many the film will have

    const int m_series;
    const std::optional<double> m_keys;
    FilmSettings m_offered;
    QString m_present;
    QComboBox *m_kind, *m_preset;
    QDoubleSpinBox *m_seconds, *m_degrees, *m_rate;
    QLineEdit *m_views, *m_path;
    QSpinBox *m_width, *m_height;
    QCheckBox* m_annotated;
    QLabel* m_summary;
    QList<QWidget*> m_ofTurntable, m_ofViews, m_ofLength; ///< rows that other kinds do without
};

} // namespace pellucid::gui
