#include "widgets/layouts.h"

#include <QLabel>
#include <QScrollArea>

namespace pellucid::gui {
namespace {

template <class L>
L* filled(L* box, Cells cells, int spacing) {
    box->setSpacing(spacing);
    add(*box, cells);
    return box;
}

} // namespace

void add(QBoxLayout& box, Cells cells) {
    for (const Cell& cell : cells) cell.addTo(box);
}

QHBoxLayout* rowOf(Cells cells, int spacing) { return filled(new QHBoxLayout, cells, spacing); }
QVBoxLayout* columnOf(Cells cells, int spacing) { return filled(new QVBoxLayout, cells, spacing); }

void fillScrolled(QWidget* panel, QLayout* content) {
    auto* inside = new QWidget;
    inside->setLayout(inset(content, {10, 8, 10, 8}));
    auto* scroll = new QScrollArea(panel);
    scroll->setWidget(inside);
    scroll->setWidgetResizable(true);
    scroll->setFrameShape(QFrame::NoFrame);
    panel->setLayout(inset(columnOf({scroll}), {}));
}

void addRow(QFormLayout& form, const QString& text, QWidget* buddy, QLayout* row) {
    auto* label = new QLabel(text);
    label->setBuddy(buddy);
    form.addRow(label, row);
}

QFormLayout* narrowForm(QFormLayout* form) {
    form->setRowWrapPolicy(QFormLayout::WrapLongRows);
    return form;
}

QFormLayout* scrolledForm(QWidget* panel, int spacing) {
    auto* form = narrowForm(new QFormLayout);
    form->setVerticalSpacing(spacing);
    fillScrolled(panel, form);
    return form;
}

QSize sizeWithoutScrolling(const QWidget& panel) {
    return panel.findChild<QScrollArea*>()->widget()->sizeHint() + QSize(24, 4);
}

} // namespace pellucid::gui
