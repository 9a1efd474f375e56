// Which variable drives opacity, saturation, brightness and hue (thesis eq. 6.1).
#pragma once

#include <array>

#include <QWidget>

#include "session/variable_edits.h"
#include "store/session_store.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QFormLayout;
class QLabel;
class QPushButton;
class QSlider;
class QSpinBox;

namespace pellucid::gui {

class OpenController;
class Services;

class ChannelsBox : public QWidget {
    Q_OBJECT
public:
    ChannelsBox(Services& services, OpenController& opening, QWidget* parent = nullptr);
    /// Colours of variables or of the transfer function, the one or the other.
    void toggle();

private:
    void addChannel(QFormLayout& form, Channel channel, const char* name, const QString& label, const QString& tip);
    void addHue(QFormLayout& form);
    void follow();
    void followChannel(Channel channel);
    void setOn(bool on);
    /// At once, or in a job where making colours takes long.
    void edit(const QString& text, const QString& mergeKey, const SessionStore::Change& change);
    void preview(const QString& text, const SessionStore::Change& change);
    void slideHue(int hue);
    bool isFast() const;

    Services& m_services;
    OpenController& m_opening;
    QCheckBox* m_on;
    std::array<QComboBox*, 4> m_channels{}; ///< by Channel
    QSpinBox* m_frames;
    QPushButton* m_swap;
    QSlider* m_hueSlider;
    QDoubleSpinBox *m_hueFrom, *m_hueTo;
    QLabel *m_hueSwatch, *m_note;
};

} // namespace pellucid::gui
