// One change of the transfer function that can be undone.
#pragma once

#include <QUndoCommand>

#include "models/document.h"

namespace pellucid::gui {

/// Keeps the transfer functions before and after as they were, so that undo restores every bit.
class TfCommand : public QUndoCommand {
public:
    TfCommand(Document& document, TransferFunction before, TransferFunction after, const QString& text,
              QString mergeKey)
        : QUndoCommand(text), m_document(document), m_before(std::move(before)), m_after(std::move(after)),
          m_mergeKey(std::move(mergeKey)) {}

    void undo() override { m_document.applyTf(m_before); }
    void redo() override { m_document.applyTf(m_after); }
    int id() const override { return m_mergeKey.isEmpty() ? -1 : 1; }
    bool mergeWith(const QUndoCommand* other) override;

private:
    Document& m_document;
    TransferFunction m_before, m_after;
    QString m_mergeKey;
};

} // namespace pellucid::gui
