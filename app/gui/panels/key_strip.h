// Keyframes along time, with pictures of them and between them, to be taken hold of.
#pragma once

#include <optional>
#include <vector>

#include <QImage>
#include <QWidget>

#include "session/keyframes.h"
#include "widgets/spoken_value.h"

namespace pellucid::gui {

/// Time goes from left to right, from 0 to a little beyond the last key. Above a scale with the playhead, below it a
/// picture of each key at its time, and as many between two keys as there is room for. A press or drag on the scale, or
/// between keys, moves the playhead; a click on a key selects it, a drag moves it. The strip changes nothing itself: it
/// says what is wanted.
class KeyStrip : public QWidget, public Spoken {
    Q_OBJECT
public:
    /// A place for a picture.
    struct Slot {
        double time = 0; ///< s, that the picture is of
        QRectF rect;     ///< pixels of the widget
        int key = -1;    ///< of this key; −1: between two
        QImage picture = {};
    };

    explicit KeyStrip(QWidget* parent = nullptr);

    void setKeys(const Keyframes& keys, int selected);
    void setPlayhead(double time);
    void setEditable(bool editable);

    const std::vector<Slot>& places() const { return m_slots; }
    /// Of a place that has this time now; else nothing happens.
    void setPicture(double time, const QImage& picture);
    void forgetPictures();

    double timeAt(double x) const; ///< s, from 0 on
    double xOf(double time) const; ///< pixels of the widget
    QRectF scaleRect() const;      ///< where the playhead is taken hold of

    QSize sizeHint() const override { return {600, 104}; }
    QSize minimumSizeHint() const override { return {200, 64}; }
    QString spokenValue() const override;
    std::optional<SpokenNumber> spokenNumber() override;

Q_SIGNALS:
    void picturesWanted(); ///< there are places without a picture
    void playheadMoved(double time);
    void playheadRested();
    void keySelected(int key);
    void keyDragged(int key, double time); ///< a key of those before the drag
    void keyDropped();
    void givenUp(); ///< Esc
    void stepWanted(double seconds);
    void keyStepWanted(int keys);
    void keyTimeWanted(double time); ///< of the selected key
    void addWanted();
    void removeWanted();
    void playWanted();

protected:
    bool event(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

private:
    enum class Hold { None, Playhead, Key, MovingKey };
    QRectF band() const; ///< of the pictures
    double span() const { return m_span; }
    void place();
    int keyAt(const QPointF& at) const; ///< −1: none
    QString tipAt(const QPointF& at) const;
    QStringList wordsOf(int key) const;
    void paintScale(QPainter& painter) const;
    void paintPicture(QPainter& painter, const Slot& slot) const;

    Keyframes m_keys;
    int m_selected = -1;
    double m_playhead = 0, m_span = 4; ///< s
    bool m_editable = true;
    std::vector<Slot> m_slots; ///< those of keys first, in their order
    Hold m_hold = Hold::None;
    QPointF m_pressed;
    double m_grip = 0; ///< s, from the pressed key's time to where it was pressed
    int m_held = -1;   ///< key
};

/// How the way to the next key is called: "evenly".
QString easingText(Easing easing);
/// "Key 2 at 3.5 s: front".
QString keyText(const Keyframes& keys, int key);

} // namespace pellucid::gui
