// Transfer functions for and from other programs: exported, copied as Python, opened in parts.
#pragma once

#include <QObject>

#include "tf/formats/tf_format.h"
#include "tf/formats/tf_parts.h"

namespace pellucid::gui {

class OpenController;
class Services;

class TfExchangeController : public QObject {
    Q_OBJECT
public:
    TfExchangeController(Services& services, OpenController& opening, QObject* parent = nullptr);

    void addActions();

    /// What is seen now, in the range of the volume and for its spacing. False: it could not be written, and a dialog
    /// says why.
    bool exportTf(const TfFormat& format, const QString& path);
    /// What exporting would lose.
    QStringList lossesOf(const TfFormat& format) const;
    /// To the clipboard, as a snippet of tf_snippets.h of this name.
    void copySnippet(const QString& name);
    /// Parts of a file into the transfer function of the session, as one step.
    void openParts(const QString& path, const TfParts& parts);

private:
    TfToWrite present(const std::string& path) const;
    void chooseExport();
    void chooseParts();
    void chooseParts(const QString& path);

    Services& m_services;
    OpenController& m_opening;
};

/// Makes one that lives as long as the services, and adds its actions.
void addTfExchangeActions(Services& services, OpenController& opening);

} // namespace pellucid::gui
