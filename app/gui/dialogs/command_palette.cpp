#include "dialogs/command_palette.h"

#include <algorithm>
#include <functional>
#include <utility>

#include <QCoreApplication>
#include <QHeaderView>
#include <QKeyEvent>
#include <QLineEdit>
#include <QSettings>
#include <QTimer>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "widgets/named.h"

namespace pellucid::gui {

namespace {

constexpr const char* kRecent = "paletteRecent";
constexpr int kMostRecent = 8;
constexpr QSize kSize{560, 420};

/// Whether the letters occur in this order, with anything between them.
bool occurInOrder(const QString& letters, const QString& text) {
    qsizetype at = 0;
    for (const QChar letter : letters) {
        at = text.indexOf(letter, at, Qt::CaseInsensitive);
        if (at < 0) return false;
        ++at;
    }
    return true;
}

/// Of one word in one text.
int wordScore(const QString& word, const QString& text) {
    const qsizetype at = text.indexOf(word, 0, Qt::CaseInsensitive);
    if (at == 0) return 100;
    for (qsizetype n = at; n > 0; n = text.indexOf(word, n + 1, Qt::CaseInsensitive))
        if (!text[n - 1].isLetterOrNumber()) return 80;
    if (at > 0) return 50;
    return word.size() > 1 && occurInOrder(word, text) ? 10 : 0;
}

} // namespace

int paletteScore(const QString& typed, const QString& text, const QString& place, const QString& tip) {
    int sum = 0;
    const QStringList words = typed.split(' ', Qt::SkipEmptyParts);
    for (const QString& word : words) {
        const bool isInTip = word.size() > 2 && tip.contains(word, Qt::CaseInsensitive); // single letters always are
        const int best = std::max({wordScore(word, text), wordScore(word, place) / 4, isInTip ? 8 : 0});
        if (best == 0) return 0;
        sum += best;
    }
    return words.isEmpty() ? 1 : sum;
}

CommandPalette::CommandPalette(std::vector<ActionRow> rows, QWidget* parent)
    : QDialog(parent), m_rows(std::move(rows)),
      m_find(named(new QLineEdit(this), "paletteFind",
                   tr("A few letters of what you want; Up and Down choose, Return does it"))),
      m_list(named(new QTreeWidget(this), "paletteList", tr("What can be done, with its menu and its keys"))) {
    setObjectName("commandPalette");
    setWindowTitle(tr("Do something"));
    m_find->setPlaceholderText(tr("What do you want to do?"));
    m_find->setAccessibleName(tr("What do you want to do?"));
    m_find->setClearButtonEnabled(true);
    m_find->installEventFilter(this);
    m_list->setAccessibleName(tr("What can be done"));
    m_list->setHeaderHidden(true);
    m_list->setRootIsDecorated(false);
    m_list->setUniformRowHeights(true);
    m_list->setColumnCount(3);
    m_list->setFocusPolicy(Qt::NoFocus); // the line keeps the keys
    m_list->header()->setStretchLastSection(false);
    m_list->header()->setSectionResizeMode(0, QHeaderView::Stretch);
    for (const int column : {1, 2}) m_list->header()->setSectionResizeMode(column, QHeaderView::ResizeToContents);
    auto* layout = new QVBoxLayout(this);
    layout->addWidget(m_find);
    layout->addWidget(m_list, 1);
    connect(m_find, &QLineEdit::textChanged, this, &CommandPalette::fill);
    connect(m_find, &QLineEdit::returnPressed, this, &CommandPalette::choose);
    connect(m_list, &QTreeWidget::itemClicked, this, [this](QTreeWidgetItem* item) {
        m_list->setCurrentItem(item);
        choose();
    });
    resize(kSize.boundedTo(parent->size()));
    fill({});
}

void CommandPalette::fill(const QString& typed) {
    const QStringList recent = QSettings().value(kRecent).toStringList();
    struct Fit {
        int score;
        const ActionRow* row;
    };
    std::vector<Fit> fits;
    for (const ActionRow& row : m_rows) {
        int score = paletteScore(typed, plainText(*row.action), row.place, row.action->statusTip());
        if (score == 0) continue;
        // Among equals, the latest ones first.
        if (const auto at = recent.indexOf(row.action->objectName()); at >= 0)
            score += kMostRecent - static_cast<int>(at);
        fits.push_back({score, &row});
    }
    std::ranges::stable_sort(fits, std::greater{}, &Fit::score);
    m_list->clear();
    for (const Fit& fit : fits) {
        QAction* const action = fit.row->action;
        auto* item = new QTreeWidgetItem(m_list, {plainText(*action), fit.row->place, keysText(*action)});
        item->setData(0, Qt::UserRole, QVariant::fromValue(static_cast<QObject*>(action)));
        item->setToolTip(0, action->statusTip());
        if (action->isCheckable()) item->setCheckState(0, action->isChecked() ? Qt::Checked : Qt::Unchecked);
        item->setDisabled(!action->isEnabled());
    }
    for (int n = 0; n < m_list->topLevelItemCount(); ++n)
        if (!m_list->topLevelItem(n)->isDisabled()) {
            m_list->setCurrentItem(m_list->topLevelItem(n));
            break;
        }
}

bool CommandPalette::eventFilter(QObject* watched, QEvent* event) {
    if (event->type() != QEvent::KeyPress) return QDialog::eventFilter(watched, event);
    switch (static_cast<QKeyEvent*>(event)->key()) {
    case Qt::Key_Up:
    case Qt::Key_Down:
    case Qt::Key_PageUp:
    case Qt::Key_PageDown:
        QCoreApplication::sendEvent(m_list, event);
        return true;
    default:
        return QDialog::eventFilter(watched, event);
    }
}

void CommandPalette::choose() {
    const QTreeWidgetItem* item = m_list->currentItem();
    if (item == nullptr || item->isDisabled()) return;
    m_chosen = qobject_cast<QAction*>(item->data(0, Qt::UserRole).value<QObject*>());
    QStringList recent = QSettings().value(kRecent).toStringList();
    recent.removeAll(m_chosen->objectName());
    recent.prepend(m_chosen->objectName());
    QSettings().setValue(kRecent, recent.mid(0, kMostRecent));
    accept();
}

void showCommandPalette(std::vector<ActionRow> rows, QWidget* parent) {
    CommandPalette palette(std::move(rows), parent);
    if (palette.exec() != QDialog::Accepted || palette.chosen() == nullptr) return;
    palette.chosen()->trigger();
}

} // namespace pellucid::gui
