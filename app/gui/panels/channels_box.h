// Whose features are looked at, and which variables drive saturation, brightness and hue (thesis eq. 6.1).
#pragma once

#include <array>

#include <QCheckBox>
#include <QPushButton>
#include <QSlider>
#include <QSpinBox>

#include "session/variable_edits.h"
#include "store/session_store.h"
#include "widgets/controls.h"

class QFormLayout;

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
    void addFeatures(QFormLayout& form);
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
    QCheckBox* m_on = named(
        new QCheckBox(tr("&Colours from variables"), this), "hsbCheck",
        tr("Saturation, brightness and hue of each voxel from variables; opacity stays with the transfer function. "
           "Figures are measured with these colours."));
    std::array<QComboBox*, 4> m_channels{}; ///< by Channel
    QSpinBox* m_featureFrames =
        named(new QSpinBox(this), "featureFrames",
              tr("The features are of the standard deviation of each voxel over the latest n frames"));
    QSpinBox* m_frames = named(new QSpinBox(this), "hsbFrames",
                               tr("Volatility is the standard deviation of a voxel over the latest n frames"));
    QPushButton* m_swap =
        named(new QPushButton(tr("S&wap opacity and brightness"), this), "hsbSwap",
              tr("The variable of brightness drives opacity, with its own transfer function, and the other way round; "
                 "pressed again, everything is as before"));
    QSlider* m_hueSlider =
        named(new QSlider(Qt::Horizontal, this), "hsbHueSlider", tr("The hue, degrees: 0 red, 120 green, 240 blue"));
    QDoubleSpinBox* m_hueFrom =
        named(new QDoubleSpinBox(this), "hsbHueFrom", tr("Hue, degrees; with a variable, that of its least value"));
    QDoubleSpinBox* m_hueTo =
        named(new QDoubleSpinBox(this), "hsbHueTo", tr("Hue of the variable's largest value, degrees"));
    QLabel* m_hueSwatch = named(new QLabel(this), "hsbHueSwatch");
    QLabel* m_note = wrappedLabel("hsbNote", this);
};

} // namespace pellucid::gui
