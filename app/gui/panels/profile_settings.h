// Which definitions the figures follow: a row of the features panel's settings.
#pragma once

#include <QWidget>

class QComboBox;
class QLabel;
class QPushButton;

namespace pellucid::gui {

class Services;

/// Pellucid's own definitions or the published ones, and for those the face of the grid that they look at; a remark
/// where that is not what the picture shows, and a button to go there.
class ProfileSettings : public QWidget {
    Q_OBJECT
public:
    explicit ProfileSettings(Services& services, QWidget* parent = nullptr);

private:
    void edit();
    void follow();
    void lookAlong();

    Services& m_services;
    QComboBox *m_profile, *m_along;
    QLabel* m_remark;
    QPushButton* m_look;
};

} // namespace pellucid::gui
