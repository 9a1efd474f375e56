// The dock with the sphere of views.
#pragma once

#include <optional>

#include <QWidget>

#include "optimize/views/view_search.h"

class QComboBox;
class QLabel;
class QProgressBar;
class QPushButton;

namespace pellucid::gui {

class ViewGlobe;
class ViewSearchController;
class Services;

/// What is judged, the sphere in its colours, the best view in words, and the ways there.
class ViewsPanel : public QWidget {
    Q_OBJECT
public:
    ViewsPanel(Services& services, ViewSearchController& search, QWidget* parent = nullptr);

private:
    void fillFigures();
    void refresh();
    QString words() const;
    std::optional<double> measuredHere(const ViewMetric& metric) const; ///< empty: not of the present state

    Services& m_services;
    ViewSearchController& m_search;
    QComboBox* m_figure;
    ViewGlobe* m_globe;
    QLabel* m_words;
    QProgressBar* m_progress;
    QPushButton *m_look, *m_go, *m_optimize;
    int m_gesture = 0;
};

} // namespace pellucid::gui
