// The dock that tells how each feature's VWS follows each opacity, and which feature hides which.
#include <algorithm>
#include <cmath>
#include <utility>

#include <QAction>
#include <QApplication>
#include <QClipboard>
#include <QEvent>
#include <QHeaderView>
#include <QTableWidget>
#include <QTimer>
#include <QVBoxLayout>

#include "panels/panel.h"
#include "services/services.h"
#include "widgets/controls.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kRowNames = 92;                 // at most, pixels
constexpr int kColumns = 4, kCellMargins = 8; // columns that are seen at once, beside their numbers

/// With so many digits that count, or whole.
QString signedText(double value, int digits) {
    QString text = QString::asprintf("%+.*g", digits, value);
    if (text.contains('e') && std::abs(value) >= 1) text = QString::asprintf("%+.0f", value);
    return text.replace('-', QChar(0x2212));
}

/// A square table of the present state, as a heat map: ∂W_i/∂x_j, row i a feature's VWS, column j a feature's opacity;
/// or the part of feature i that feature j hides. Pale while the figures are of an older state.
class InfluencePanel : public QWidget {
public:
    InfluencePanel(SessionStore& store, Results& results, QWidget* parent);

private:
    bool eventFilter(QObject* watched, QEvent* event) override;
    void showEvent(QShowEvent* event) override;
    void changeEvent(QEvent* event) override;
    void fitColumns();
    void rebuild();
    /// What the table shows: the influence, or who hides whom. Null before it is known.
    const std::vector<std::vector<double>>* matrix() const;
    QString cellText(double value) const;
    QString cellTip(int row, int column, double value) const;
    /// Values and colours, in the cells that are there.
    void refresh();
    /// The table as lines of tab-separated columns, names first, with all digits; nothing while it is of an older
    /// state.
    void copy() const;

    SessionStore& m_store;
    Results& m_results;
    QComboBox* m_what = named(new QComboBox(this), "influenceCombo");
    QTableWidget* m_table = named(new QTableWidget(this), "influenceTable", tr("A row and a column for each feature"));
    QAction* m_copyAction = new QAction(tr("Copy the table"), m_table);
    bool m_fitsLater = false;
};

InfluencePanel::InfluencePanel(SessionStore& store, Results& results, QWidget* parent)
    : QWidget(parent), m_store(store), m_results(results) {
    addItem(*m_what, tr("Effect on attention"), {},
            tr("How fast the attention of each feature (rows) follows the opacity of another (columns). ∂W/∂x: the "
               "change of a feature's share per change of an opacity, both from 0 to 1,\n"
               "from this view and at the present opacities"));
    addItem(*m_what, tr("What hides what"), {},
            tr("How much of each feature (rows) another one hides (columns): the part of the row's visibility that "
               "comes back where the column's opacity is 0,\n"
               "from this view and at the present opacities"));
    m_what->setAccessibleName(tr("What the table tells"));
    m_table->setAccessibleName(tr("Influence of features on each other"));
    m_what->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    m_what->setMinimumContentsLength(20);
    const auto tell = [this] { m_what->setToolTip(m_what->currentData(Qt::ToolTipRole).toString()); };
    connect(m_what, &QComboBox::currentIndexChanged, this, [this, tell] {
        tell();
        rebuild();
    });
    tell();
    m_table->setEditTriggers(QAbstractItemView::NoEditTriggers);
    m_table->setSelectionMode(QAbstractItemView::NoSelection);
    // As wide as the numbers, names in two lines: many features scroll, numbers are not cut off.
    m_table->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
    m_table->horizontalHeader()->setDefaultAlignment(Qt::AlignCenter | Qt::Alignment(Qt::TextWordWrap));
    m_table->horizontalHeader()->setFixedHeight(2 * m_table->fontMetrics().lineSpacing() + 8);
    m_table->verticalHeader()->setMaximumWidth(kRowNames);
    m_table->setHorizontalScrollMode(QAbstractItemView::ScrollPerPixel);
    m_table->setTextElideMode(Qt::ElideNone);
    for (QHeaderView* header : {m_table->horizontalHeader(), m_table->verticalHeader()})
        header->setTextElideMode(Qt::ElideMiddle);
    m_table->verticalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
    m_table->setSizeAdjustPolicy(QAbstractScrollArea::AdjustToContents);
    m_table->viewport()->installEventFilter(this);
    m_copyAction->setObjectName("copyInfluenceAction");
    m_copyAction->setShortcut(QKeySequence::Copy);
    m_copyAction->setShortcutContext(Qt::WidgetWithChildrenShortcut);
    m_table->addAction(m_copyAction);
    m_table->setContextMenuPolicy(Qt::ActionsContextMenu);
    connect(m_copyAction, &QAction::triggered, this, &InfluencePanel::copy);
    auto* column = new QVBoxLayout(this);
    column->addWidget(m_what);
    column->addWidget(m_table, 1);
    connect(&store, &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        before.tf.features == after.tf.features ? refresh() : rebuild();
    });
    connect(&results, &Results::changed, this, &InfluencePanel::refresh);
}

// All columns where they fit: names have what numbers leave them.
void InfluencePanel::fitColumns() {
    m_fitsLater = false;
    const int n = m_table->columnCount();
    if (n == 0) return;
    const int room = m_table->viewport()->width();
    const int height = m_table->horizontalHeader()->height();
    for (int i = 0; i < n; ++i) m_table->horizontalHeaderItem(i)->setData(Qt::SizeHintRole, QSize(room / n, height));
}

bool InfluencePanel::eventFilter(QObject* watched, QEvent* event) {
    // Later: it is in the middle of its layout.
    if (watched == m_table->viewport() && event->type() == QEvent::Resize && !std::exchange(m_fitsLater, true))
        QTimer::singleShot(0, this, &InfluencePanel::fitColumns);
    return QWidget::eventFilter(watched, event);
}

void InfluencePanel::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    rebuild(); // while hidden it has followed nothing
}

void InfluencePanel::changeEvent(QEvent* event) {
    QWidget::changeEvent(event);
    if (event->type() == QEvent::PaletteChange) refresh(); // cells keep their colours
}

void InfluencePanel::rebuild() {
    if (!isVisible()) return;
    const std::vector<Feature>& features = m_store.scene().tf.features;
    const int n = static_cast<int>(features.size());
    m_table->setRowCount(n);
    m_table->setColumnCount(n);
    for (int i = 0; i < n; ++i) {
        const Feature& feature = features[static_cast<std::size_t>(i)];
        const QString name = QString::fromStdString(feature.name);
        for (const Qt::Orientation side : {Qt::Vertical, Qt::Horizontal}) {
            auto* header = new QTableWidgetItem(name);
            header->setData(Qt::DecorationRole, colorFromRgb(feature.color));
            const bool influence = m_what->currentIndex() == 0;
            header->setToolTip(side == Qt::Vertical
                                   ? (influence ? tr("Attention on %1 (VWS)") : tr("How much %1 is hidden")).arg(name)
                                   : (influence ? tr("Opacity of %1") : tr("What %1 hides")).arg(name));
            side == Qt::Vertical ? m_table->setVerticalHeaderItem(i, header)
                                 : m_table->setHorizontalHeaderItem(i, header);
        }
        for (int j = 0; j < n; ++j) {
            auto* cell = new QTableWidgetItem;
            cell->setTextAlignment(Qt::AlignCenter);
            m_table->setItem(i, j, cell);
        }
    }
    fitColumns();
    constexpr int kRows = 4; // at least, without a scroll bar
    m_table->setMinimumWidth(kRowNames + std::min(n, kColumns) *
                                             (m_table->fontMetrics().horizontalAdvance("-100.0 %") + kCellMargins));
    m_table->setMinimumHeight(m_table->horizontalHeader()->height() +
                              std::min(n, kRows) * m_table->verticalHeader()->sectionSizeHint(0) + 4);
    refresh();
}

const std::vector<std::vector<double>>* InfluencePanel::matrix() const {
    return m_what->currentIndex() == 0 ? m_results.influence() : m_results.occlusion();
}

QString InfluencePanel::cellText(double value) const {
    return m_what->currentIndex() == 0 ? signedText(value, 2) : tr("%1 %").arg(std::lround(100 * value));
}

QString InfluencePanel::cellTip(int row, int column, double value) const {
    const QString of = m_table->verticalHeaderItem(row)->text(), by = m_table->horizontalHeaderItem(column)->text();
    if (m_what->currentIndex() == 0)
        return tr("Raising the opacity of %1 by 0.01 changes the attention on %2 (VWS) by about %3")
            .arg(by, of, signedText(0.01 * value, 3));
    if (row == column) return tr("A feature does not hide itself here");
    return tr("%1 hides %2 % of the visibility of %3").arg(by).arg(100 * value, 0, 'f', 1).arg(of);
}

void InfluencePanel::refresh() {
    const auto* const values = matrix();
    const int n = m_table->rowCount();
    const bool known = values && static_cast<int>(values->size()) == n, current = m_results.influenceIsCurrent();
    m_copyAction->setEnabled(known && current);
    if (!isVisible()) return;
    double largest = 0;
    if (known)
        for (const auto& row : *values)
            for (const double value : row) largest = std::max(largest, std::abs(value));
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            QTableWidgetItem* const cell = m_table->item(i, j);
            if (!known) {
                cell->setText({});
                cell->setToolTip({});
                cell->setBackground({});
                continue;
            }
            const double value = (*values)[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
            const double share = largest > 0 ? std::abs(value) / largest : 0;
            cell->setText(cellText(value));
            cell->setToolTip(current ? cellTip(i, j, value) : tr("Of an earlier state; being measured"));
            cell->setBackground(
                between(theme::kPanel, value < 0 ? theme::kFalls : theme::kAccent, (current ? 0.6 : 0.15) * share));
            cell->setForeground(current ? theme::kText : theme::kFaint);
        }
}

void InfluencePanel::copy() const {
    const auto* const values = matrix();
    if (values == nullptr || !m_results.influenceIsCurrent() || static_cast<int>(values->size()) != m_table->rowCount())
        return;
    QString text;
    for (int j = 0; j < m_table->columnCount(); ++j) text += '\t' + m_table->horizontalHeaderItem(j)->text();
    text += '\n';
    for (int i = 0; i < m_table->rowCount(); ++i) {
        text += m_table->verticalHeaderItem(i)->text();
        for (const double value : (*values)[static_cast<std::size_t>(i)]) text += '\t' + QString::number(value, 'g', 9);
        text += '\n';
    }
    QApplication::clipboard()->setText(text);
}

} // namespace

PanelInfo influencePanel() {
    return {.id = "influence",
            .title = QObject::tr("Influence"),
            .group = PanelGroup::Shares,
            .visible = false, // costs a sweep more
            .tabOf = "features",
            .keys = QKeySequence("Ctrl+I"),
            .tip = QObject::tr("How attention follows each opacity, and which feature hides which"),
            .make = [](Services& services, Controllers&, QWidget* parent) {
                services.actions().addGestures({{QObject::tr("Influence"), "Ctrl+C", QObject::tr("copy the table")}});
                Results& results = services.results();
                QObject::connect(&services.panels(), &Panels::visibilityChanged, &results,
                                 [&results](const QString& id, bool visible) {
                                     if (id == "influence") results.setInfluenceWanted(visible);
                                 });
                return new InfluencePanel(services.store(), results, parent);
            }};
}

} // namespace pellucid::gui
