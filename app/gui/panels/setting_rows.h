// Rows of a form that are bound to settings: each shows its setting, previews it while a slider is held, and edits it
// as a step of the history.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include <QObject>
#include <QString>

#include "base/setting.h"
#include "store/session_store.h"

class QDoubleSpinBox;
class QFormLayout;
class QSlider;
class QToolButton;
class QWidget;

namespace pellucid::gui {

class Services;

/// Where a struct of settings lies in a session.
struct SettingPart {
    std::span<const Setting> settings;
    std::function<const void*(const Session&)> read;
    std::function<void(Session&, const std::function<void(void*)>&)> edit;
    std::function<bool(const Session&, const Session&)> isSame;
};
/// `within` leads from a part of the session to the settings in it.
template <class T, class Held, class Within>
SettingPart settingPartWithin(Part<Held> Session::*part, Within within) {
    return {settingsOf<T>(), [=](const Session& s) -> const void* { return &within(const_cast<Held&>(*(s.*part))); },
            [=](Session& s, const auto& change) { (s.*part).edit([&](Held& held) { change(&within(held)); }); },
            [=](const Session& a, const Session& b) { return (a.*part).isSame(b.*part); }};
}
/// `&Session::optimize`.
template <class T, class Held>
SettingPart settingPart(Part<Held> Session::*part) {
    return settingPartWithin<T>(part, [](Held& held) -> T& { return held; });
}
/// `&Session::measure, &MeasureSettings::saliency`.
template <class T, class Held>
SettingPart settingPart(Part<Held> Session::*part, T Held::*member) {
    return settingPartWithin<T>(part, [=](Held& held) -> T& { return held.*member; });
}

/// What a row looks like, as far as its setting does not tell.
struct RowLook {
    QString id;          ///< object name of its control; that of a slider is id + "Slider"
    bool slider = false; ///< a number: with a slider, which may be logarithmic
    bool logarithmic = false;
    int decimals = 2;
    double step = 0.05;
    double factor = 1;                           ///< from the setting to what is shown
    QString suffix = {};                         ///< in the place of the setting's unit
    std::optional<double> least = {}, most = {}; ///< of the slider, as shown; else the ends of the range
    std::function<double()> automatic = {};      ///< of an optional number: what none stands for
    QString colorId = {};                        ///< of an optional colour: object name of its button
    Rgb firstColor = {};                         ///< of an optional colour that is switched on
    QString stepText = {};                       ///< names its steps; empty: its setting does
    std::function<void(void*)> then = {}; ///< done to the settings after a change of this one: what follows of it
};

/// A slider of a share, from 1 % on.
inline RowLook percentLook(const QString& id) {
    return {.id = id, .slider = true, .decimals = 0, .step = 5, .factor = 100, .suffix = QObject::tr(" %"), .least = 1};
}

/// Of the history, for rows that share it: steps of one key in a row become one. Empty: each row has its own.
struct RowStep {
    QString text = {}, mergeKey = {};
};

class SettingRows : public QObject {
    Q_OBJECT
public:
    /// How a change becomes a step of the history; steps of one `mergeKey` in a row are one.
    using Commit =
        std::function<void(const QString& text, const QString& mergeKey, const SessionStore::Change& change)>;

    /// Adds to `form`, whose widget is the owner. The rows follow the session by themselves.
    SettingRows(Services& services, QFormLayout& form, SettingPart part, RowStep step = {});

    /// The control of the setting with this key.
    QWidget* add(const char* key, const RowLook& look);
    /// In the place of the store's edit().
    void setCommit(Commit commit) { m_commit = std::move(commit); }
    /// In the place of the store's preview(), and when there is one: the picture may be too slow to follow the hand.
    using Preview = std::function<void(const QString& text, const SessionStore::Change& change)>;
    void setPreview(Preview preview, std::function<bool()> isFast) {
        m_preview = std::move(preview);
        m_isFast = std::move(isFast);
    }
    /// The rows from top to bottom: what they show, and the control that has their name.
    struct Row {
        const Setting* setting;
        QWidget* control;
    };
    const std::vector<Row>& rows() const { return m_rows; }
    const void* present() const; ///< the settings of the session
    /// Shows the present session; what does not count there, and all where nothing can be edited, is grey.
    void follow();

private:
    using Write = std::function<void(void*)>;
    struct Scale;
    void addNumber(const Setting& setting, const RowLook& look, std::vector<QWidget*>& controls);
    QWidget* makeWhole(const Setting& setting, const RowLook& look);
    QWidget* makeCheck(const Setting& setting);
    QWidget* makeChoice(const Setting& setting);
    void addColor(const Setting& setting, const RowLook& look, std::vector<QWidget*>& controls);
    QSlider* makeSlider(const Setting& setting, const RowLook& look, const Scale& scale);
    QToolButton* makeAutomatic(const Setting& setting, const RowLook& look, const QDoubleSpinBox& box);
    void edit(const Setting& setting, const QString& mergeKey, const Write& write);
    SessionStore::Change changeOf(const Setting& setting, const Write& write) const;
    QString textOf(const Setting& setting) const;

    Services& m_services;
    QFormLayout& m_form;
    SettingPart m_part;
    RowStep m_step;
    Commit m_commit;
    Preview m_preview;
    std::function<bool()> m_isFast;
    std::map<const Setting*, RowLook> m_looks;
    std::vector<Row> m_rows;
    std::vector<std::function<void()>> m_show;
};

} // namespace pellucid::gui
