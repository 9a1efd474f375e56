// Everything that can be done, found by typing a few letters of it.
#pragma once

#include <vector>

#include <QDialog>

#include "dialogs/action_row.h"

class QLineEdit;
class QTreeWidget;

namespace pellucid::gui {

/// How well what was typed fits an entry; 0: not at all. Each word has to occur, or its letters in their order. The
/// beginning of the text counts most, then that of a word in it; the place and the tool tip count less than the text.
int paletteScore(const QString& typed, const QString& text, const QString& place, const QString& tip);

/// A line to type into, and what fits below it, the best first; before anything is typed the latest that were chosen
/// here. Up and down move the selection while one types, Return does what is selected. What cannot be done now is
/// listed, grey.
class CommandPalette : public QDialog {
    Q_OBJECT
public:
    CommandPalette(std::vector<ActionRow> rows, QWidget* parent);

    /// The action that was chosen; null: none.
    QAction* chosen() const { return m_chosen; }

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void fill(const QString& typed);
    void choose();

    std::vector<ActionRow> m_rows;
    QLineEdit* m_find;
    QTreeWidget* m_list;
    QAction* m_chosen = nullptr;
};

/// Shows it, and does what is chosen.
void showCommandPalette(std::vector<ActionRow> rows, QWidget* parent);

} // namespace pellucid::gui
