// The height field under the volume: its file, scale, relief and colours.
#pragma once

#include <QWidget>

#include "session/session.h"

class QCheckBox;
class QComboBox;
class QLabel;
class QPushButton;
class QToolButton;

namespace pellucid::gui {

class OpenController;
class Services;

class GroundBox : public QWidget {
    Q_OBJECT
public:
    GroundBox(Services& services, OpenController& opening, QWidget* parent = nullptr);

private:
    using Change = std::function<void(GroundView&)>;
    void follow();
    void chooseFile();
    void lay(const VolumeSource& source);
    void edit(const QString& text, const QString& mergeKey, const Change& change);

    Services& m_services;
    OpenController& m_opening;
    QLabel* m_file;
    QToolButton* m_choose;
    QPushButton* m_remove;
    QCheckBox* m_shown;
    QComboBox* m_colorMap;
};

} // namespace pellucid::gui
