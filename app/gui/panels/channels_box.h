// Which variable drives opacity, saturation, brightness and hue (thesis eq. 6.1).
#pragma once

#include <array>
#include <optional>

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
class QToolButton;

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
    using Change = std::function<void(HsbMapping&)>;
    /// The scale of saturation or of darkness.
    struct Scale {
        std::optional<double> HsbMapping::*value;
        double Scene::*present;
        QSlider* slider;
        QDoubleSpinBox* box;
        QToolButton* automatic;
        QString name;
    };
    void addChannel(QFormLayout& form, Channel channel, const char* name, const QString& label, const QString& tip);
    void addScale(QFormLayout& form, std::size_t index, const char* name, const QString& label, const QString& tip);
    void addHue(QFormLayout& form);
    void follow();
    void followChannel(Channel channel);
    void setOn(bool on);
    void edit(const QString& text, const QString& mergeKey, const Change& change);
    /// While the hand moves the picture follows, where making colours is fast enough for that.
    void slide(const QSlider& slider, const QString& text, const Change& change);
    bool isFast() const;

    Services& m_services;
    OpenController& m_opening;
    QCheckBox* m_on;
    std::array<QComboBox*, 4> m_channels{}; ///< by Channel
    std::array<Scale, 2> m_scales{};
    QSpinBox* m_frames;
    QPushButton* m_swap;
    QSlider* m_hueSlider;
    QDoubleSpinBox *m_hueFrom, *m_hueTo;
    QLabel *m_hueSwatch, *m_note;
    bool m_showing = false; ///< the controls show, they do not edit
};

} // namespace pellucid::gui
