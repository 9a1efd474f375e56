// What the entropy refiner does: its settings, what it brings out, and what came of it.
#pragma once

#include <optional>
#include <vector>

#include <QCheckBox>
#include <QFormLayout>
#include <QPushButton>

#include "controllers/refine_controller.h"
#include "jobs/rest_timer.h"
#include "widgets/controls.h"
#include "widgets/plot_view.h"
#include "widgets/spoken_value.h"

namespace pellucid::gui {

class Services;

/// One bar per edge of the curve: its weight before the refinement (pale) and now. Heights are square roots.
class EdgeBars : public QWidget, public Spoken {
    Q_OBJECT
public:
    struct Bar {
        double weight = 0;            ///< now
        std::optional<double> before; ///< empty: nothing was refined
        QColor color;
        bool participates = true; ///< one of its ends can move
        QString text;             ///< "values −20 to 40"
    };
    explicit EdgeBars(QWidget* parent);
    void setBars(std::vector<Bar> bars);
    const std::vector<Bar>& bars() const { return m_bars; }

    QSize sizeHint() const override { return {260, 96}; }
    QSize minimumSizeHint() const override { return {120, 80}; }
    QString spokenValue() const override;

protected:
    void paintEvent(QPaintEvent* event) override;
    bool event(QEvent* event) override;

private:
    QRectF cell(std::size_t i) const;
    QString tipAt(int x) const;
    QStringList wordsOf(const Bar& bar) const;
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
    QToolButton* regionButton(QAction& action, const QString& text);
    std::vector<EdgeBars::Bar> bars() const;
    void showOutcome();
    void showNote(const Refinement* refinement); ///< null: there is none
    void compare();

    Services& m_services;
    RefineController& m_refining;
    QPushButton* m_refine = named(new QPushButton(tr("&Refine"), this), "refineNowButton",
                                  tr("Refine the opacities with these settings (Ctrl+R)"));
    QPushButton* m_pair = named(new QPushButton(tr("&Side by side…"), this), "sideBySideButton",
                                tr("The picture before and after the latest refinement"));
    QCheckBox* m_live = named(new QCheckBox(tr("Li&ve"), this), "liveRefineCheck",
                              tr("Refine after every edit: what you move stays where you put it,\n"
                                 "the other points give way evenly, so that the total opacity stays"));
    QCheckBox* m_ghost = named(new QCheckBox(tr("Show the &curve before"), this), "ghostCheck",
                               tr("Dashed, behind the curve: what it was before the latest refinement"));
    QLabel* m_priority =
        withAnyWidth(named(new QLabel(this), "refinePriority",
                           tr("What becomes more opaque, relative to everything else. Click on the palette below the\n"
                              "curve for a value, or select a part of the picture")));
    QToolButton* m_nothing = named(toolButton(tr("Clear"), this), "clearPriorityButton",
                                   tr("Give no value or region priority; the opacities stay as they are"));
    QLabel* m_profile = withAnyWidth(wrappedLabel("refineProfile", this)); ///< which definitions, where not Pellucid's
    QFormLayout* m_form = nullptr;
    std::vector<int> m_steps; ///< rows of the form: the published profile has steps of its own
    QLabel* m_words = withAnyWidth(wrappedLabel("refineWords", this));
    QLabel* m_note = withAnyWidth(wrappedLabel("refineNote", this));
    QLabel* m_figures = withAnyWidth(wrappedLabel("refineFigures", this));
    QLabel* m_comparison = withAnyWidth(wrappedLabel("refineComparison", this));
    QPushButton* m_help = named(new QPushButton(this), "refineHelpButton",
                                tr("Another way to refine, which keeps the picture from getting dark"));
    EdgeBars* m_edges = named(new EdgeBars(this), "refineEdges");
    PlotView* m_plot = named(new PlotView(this), "refineCurve",
                             tr("Energy, the variance of the edge weights, over the steps; logarithmic"));
    RestTimer m_wait{300, [this] { compare(); }}; ///< before the methods are compared
    Job<Comparing, RefineComparison> m_compare;
};

} // namespace pellucid::gui
