#include "influence_panel.h"

#include <algorithm>
#include <cmath>

#include <QAction>
#include <QApplication>
#include <QClipboard>
#include <QHeaderView>
#include <QLabel>
#include <QTableWidget>
#include <QVBoxLayout>

#include "theme.h"

namespace pellucid::gui {
namespace {

QString signedText(double value) { return QString::asprintf("%+.3g", value).replace('-', QChar(0x2212)); }

QColor blend(const QColor& from, const QColor& to, double share) {
    const auto part = [share](int a, int b) { return static_cast<int>(std::lround(a + share * (b - a))); };
    return {part(from.red(), to.red()), part(from.green(), to.green()), part(from.blue(), to.blue())};
}

} // namespace

InfluencePanel::InfluencePanel(Document& document, QWidget* parent)
    : QWidget(parent), m_document(document), m_table(new QTableWidget(this)) {
    auto* label = new QLabel(tr("How fast each VWS (rows) follows each opacity (columns)"), this);
    label->setWordWrap(true);
    label->setToolTip(tr("∂W/∂x: the change of a feature's share per change of an opacity, both from 0 to 1,\n"
                         "from this view and at the present opacities"));
    m_table->setObjectName("influenceTable");
    m_table->setEditTriggers(QAbstractItemView::NoEditTriggers);
    m_table->setSelectionMode(QAbstractItemView::NoSelection);
    m_table->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
    m_table->verticalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
    auto* copyAction = new QAction(tr("Copy the table"), m_table);
    copyAction->setObjectName("copyInfluenceAction");
    copyAction->setShortcut(QKeySequence::Copy);
    copyAction->setShortcutContext(Qt::WidgetWithChildrenShortcut);
    m_table->addAction(copyAction);
    m_table->setContextMenuPolicy(Qt::ActionsContextMenu);
    connect(copyAction, &QAction::triggered, this, &InfluencePanel::copy);
    auto* column = new QVBoxLayout(this);
    column->addWidget(label);
    column->addWidget(m_table, 1);
    connect(&document, &Document::influenceChanged, this, &InfluencePanel::update);
    connect(&document, &Document::volumeChanged, this, &InfluencePanel::update);
    connect(&document, &Document::tfChanged, this, &InfluencePanel::update);
    connect(&document, &Document::cameraChanged, this, &InfluencePanel::update);
    update();
}

void InfluencePanel::update() {
    const std::vector<Feature>& features = m_document.tf().features;
    const auto& influence = m_document.influence();
    const int n = static_cast<int>(features.size());
    const bool known = influence && influence->size() == features.size(), current = m_document.influenceIsCurrent();
    m_table->setRowCount(n);
    m_table->setColumnCount(n);
    double largest = 0;
    if (known)
        for (const auto& row : *influence)
            for (const double value : row) largest = std::max(largest, std::abs(value));
    static const QColor kFalls{0xd9, 0x7a, 0x2b}; // with the accent a pair that everyone can tell apart
    for (int i = 0; i < n; ++i) {
        const QString name = QString::fromStdString(features[static_cast<std::size_t>(i)].name);
        for (const Qt::Orientation side : {Qt::Vertical, Qt::Horizontal}) {
            auto* header = new QTableWidgetItem(name);
            header->setData(Qt::DecorationRole, colorFromRgb(features[static_cast<std::size_t>(i)].color));
            header->setToolTip(side == Qt::Vertical ? tr("VWS of %1").arg(name) : tr("Opacity of %1").arg(name));
            side == Qt::Vertical ? m_table->setVerticalHeaderItem(i, header)
                                 : m_table->setHorizontalHeaderItem(i, header);
        }
        for (int j = 0; j < n; ++j) {
            auto* cell = new QTableWidgetItem;
            cell->setTextAlignment(Qt::AlignCenter);
            if (known) {
                const double value = (*influence)[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
                const QString cause = QString::fromStdString(features[static_cast<std::size_t>(j)].name);
                cell->setText(signedText(value));
                cell->setToolTip(tr("Raising the opacity of %1 by 0.01 changes the VWS of %2 by about %3")
                                     .arg(cause, name, signedText(0.01 * value)));
                const double share = largest > 0 ? std::abs(value) / largest : 0;
                cell->setBackground(
                    blend(theme::kPanel, value < 0 ? kFalls : theme::kAccent, (current ? 0.6 : 0.15) * share));
                cell->setForeground(current ? theme::kText : theme::kFaint);
            }
            m_table->setItem(i, j, cell);
        }
    }
}

void InfluencePanel::copy() const {
    const auto& influence = m_document.influence();
    if (!influence || static_cast<int>(influence->size()) != m_table->rowCount()) return;
    QString text;
    for (int j = 0; j < m_table->columnCount(); ++j) text += '\t' + m_table->horizontalHeaderItem(j)->text();
    text += '\n';
    for (int i = 0; i < m_table->rowCount(); ++i) {
        text += m_table->verticalHeaderItem(i)->text();
        for (const double value : (*influence)[static_cast<std::size_t>(i)])
            text += '\t' + QString::number(value, 'g', 9);
        text += '\n';
    }
    QApplication::clipboard()->setText(text);
}

} // namespace pellucid::gui
