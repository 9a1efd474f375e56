#include "dialogs/tf_parts_dialog.h"

#include <QCheckBox>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "dialogs/closing_buttons.h"
#include "widgets/layouts.h"
#include "widgets/named.h"

namespace pellucid::gui {

TfPartsDialog::TfPartsDialog(const QString& name, const TfParts& has, const QStringList& notices, QWidget* parent)
    : QDialog(parent), m_colors(named(new QCheckBox(tr("&Colours"), this), "tfPartColors",
                                      tr("The colours of the file, along its values"))),
      m_opacities(named(new QCheckBox(tr("&Opacities, with their features"), this), "tfPartOpacities",
                        tr("How opaque each value is, and the features that follow from it"))),
      m_range(named(new QCheckBox(tr("&Range of values"), this), "tfPartRange",
                    tr("The values that the file is written for"))) {
    setObjectName("tfPartsDialog");
    setWindowTitle(tr("Open parts of a transfer function"));
    auto* column = inset(new QVBoxLayout(this), {18, 16, 18, 12});
    auto* question = new QLabel(tr("Take from %1").arg(name), this);
    question->setTextFormat(Qt::PlainText);
    column->addWidget(question);
    auto* buttons = closingButtons(*this, QDialogButtonBox::Open | QDialogButtonBox::Cancel);
    for (const auto& [box, there] :
         {std::pair{m_colors, has.colors}, {m_opacities, has.opacities}, {m_range, has.range}}) {
        box->setEnabled(there);
        box->setChecked(there);
        column->addWidget(box);
        connect(box, &QCheckBox::toggled, this,
                [this, buttons] { buttons->button(QDialogButtonBox::Open)->setEnabled(parts().any()); });
    }
    if (!notices.isEmpty()) {
        auto* said = named(new QLabel(notices.join('\n'), this), "tfPartNotices");
        said->setTextFormat(Qt::PlainText);
        said->setWordWrap(true);
        column->addWidget(said);
    }
    column->addWidget(buttons);
}

TfParts TfPartsDialog::parts() const { return {m_colors->isChecked(), m_opacities->isChecked(), m_range->isChecked()}; }

} // namespace pellucid::gui
