// icon_pictures DRAWING.svg PREFIX SIZE…: the icon as PREFIX-SIZE.png for each size, in pixels. Runs while the program
// is built, and needs no display.
#include <cstdio>

#include <QImage>
#include <QPainter>
#include <QString>
#include <QSvgRenderer>

int main(int argc, char** argv) {
    if (argc < 4) {
        std::fprintf(stderr, "usage: icon_pictures DRAWING.svg PREFIX SIZE...\n");
        return 2;
    }
    QSvgRenderer drawing(QString::fromLocal8Bit(argv[1]));
    if (!drawing.isValid()) {
        std::fprintf(stderr, "icon_pictures: error: cannot read the drawing, %s, check the file\n", argv[1]);
        return 1;
    }
    for (int i = 3; i < argc; ++i) {
        const int size = QString::fromLocal8Bit(argv[i]).toInt();
        const QString path = QString::fromLocal8Bit(argv[2]) + "-" + QString::number(size) + ".png";
        QImage image(size, size, QImage::Format_ARGB32_Premultiplied);
        if (image.isNull()) return 2;
        image.fill(Qt::transparent);
        QPainter painter(&image);
        drawing.render(&painter);
        painter.end();
        if (!image.save(path, "PNG")) {
            std::fprintf(stderr, "icon_pictures: error: cannot write, %s, check the folder\n", qPrintable(path));
            return 1;
        }
    }
    return 0;
}
