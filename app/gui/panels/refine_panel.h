// What the entropy refiner does: its settings, what it brings out, and what came of it.
#pragma once

#include <optional>
#include <vector>

#include <QTimer>
#include <QWidget>

#include "controllers/refine_controller.h"

class QCheckBox;
class QLabel;
class QPushButton;
class QToolButton;

namespace pellucid::gui {

class PlotView;
class Services;

/// One bar per edge of the curve: its weight before the refinement (pale) and now. Heights are square roots.
class EdgeBars : public QWidget {
    Q_OBJECT
public:
    struct Bar {
        double weight = 0;            ///< now
        std::optional<double> before; ///< empty: nothing was refined
        QColor color;
        bool participates = true; ///< one of its ends can move
        QString text;             ///< "values −20 to 40"
    };
    using QWidget::QWidget;
    void setBars(std::vector<Bar> bars);
    const std::vector<Bar>& bars() const { return m_bars; }

    QSize sizeHint() const override { return {260, 96}; }
    QSize minimumSizeHint() const override { return {120, 80}; }

protected:
    void paintEvent(QPaintEvent* event) override;
    bool event(QEvent* event) override;

private:
    QRectF cell(std::size_t i) const;
    std::vector<Bar> m_bars;
};

class RefinePanel : public QWidget {
    Q_OBJECT
public:
    RefinePanel(Services& services, RefineController& refining, QWidget* parent = nullptr);

protected:
    void showEvent(QShowEvent* event) override;

private:
    struct Comparing {
        std::shared_ptr<const Histogram> histogram;
        TransferFunction start;
        RefineOptions options;
    };
    void follow();
    void showSettings();
    void showPriority();
    void showOutcome();
    void showNote(const Refinement* refinement); ///< null: there is none
    void compare();

    Services& m_services;
    RefineController& m_refining;
    QPushButton *m_refine, *m_pair;
    QCheckBox *m_live, *m_ghost;
    QLabel* m_priority;
    QToolButton* m_nothing;
    QLabel *m_words, *m_note, *m_figures, *m_comparison;
    QPushButton* m_help; ///< what keeps the picture from getting dark
    EdgeBars* m_edges;
    PlotView* m_plot;
    QTimer m_wait; ///< before the methods are compared
    Job<Comparing, RefineComparison> m_compare;
};

} // namespace pellucid::gui
