// Rows, columns and forms of controls, written as lists of what they hold.
#pragma once

#include <functional>
#include <initializer_list>

#include <QBoxLayout>
#include <QFormLayout>

namespace pellucid::gui {

/// One entry of a row or column.
class Cell {
public:
    Cell(QWidget* widget, int stretch = 0) : m_add([=](QBoxLayout& box) { box.addWidget(widget, stretch); }) {}
    Cell(QLayout* layout, int stretch = 0) : m_add([=](QBoxLayout& box) { box.addLayout(layout, stretch); }) {}
    static Cell gap(int pixels) {
        return Cell([=](QBoxLayout& box) { box.addSpacing(pixels); });
    }
    /// All the room that is left.
    static Cell rest() {
        return Cell([](QBoxLayout& box) { box.addStretch(1); });
    }
    void addTo(QBoxLayout& box) const { m_add(box); }

private:
    explicit Cell(std::function<void(QBoxLayout&)> add) : m_add(std::move(add)) {}
    std::function<void(QBoxLayout&)> m_add;
};
using Cells = std::initializer_list<Cell>;

/// Beside each other, from the left. `spacing`: pixels; −1: that of the layout around it.
QHBoxLayout* rowOf(Cells cells, int spacing = -1);
/// Below each other, from the top.
QVBoxLayout* columnOf(Cells cells, int spacing = -1);
/// More at its end.
void add(QBoxLayout& box, Cells cells);
/// A layout with margins, pixels.
template <class L>
L* inset(L* layout, const QMargins& margins) {
    layout->setContentsMargins(margins);
    return layout;
}

/// A row of several controls, of which `text` names `buddy`.
void addRow(QFormLayout& form, const QString& text, QWidget* buddy, QLayout* row);

/// In a narrow panel a control of the form stands below its label where there is no room beside it. Returns the form.
QFormLayout* narrowForm(QFormLayout* form);

/// Fills `panel`, which has no layout yet, with `content`, scrolled where there is no room for all of it.
void fillScrolled(QWidget* panel, QLayout* content);
/// The same with an empty narrowForm(), to be filled.
QFormLayout* scrolledForm(QWidget* panel, int spacing);
/// The size at which a panel made by these two does not scroll.
QSize sizeWithoutScrolling(const QWidget& panel);

} // namespace pellucid::gui
