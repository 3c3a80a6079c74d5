// Enki as a peer of benchmarks/simulator.py: builds the scene that stands on standard input, then runs as many steps as
// each further line says and answers with the seconds of processor time they took. Lengths in cm, as Enki has them.
#include <cstdint>
#include <ctime>
#include <iostream>
#include <string>
#include <vector>

#include <enki/PhysicalEngine.h>
#include <enki/robots/thymio2/Thymio2.h>

static double seconds() {
    timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return now.tv_sec + now.tv_nsec * 1e-9;
}

int main() {
    double side;
    unsigned size;
    std::cin >> side >> size;
    std::vector<uint32_t> texels(size * size);
    for (auto& texel : texels) {
        unsigned gray;
        std::cin >> gray;
        texel = 0xFF000000u | gray << 16 | gray << 8 | gray;
    }
    Enki::World world(side, side, Enki::Color::gray, Enki::World::GroundTexture(size, size, texels.data()));
    world.setRandomSeed(1);
    std::vector<Enki::Thymio2*> robots;
    std::string kind;
    while (std::cin >> kind && kind != "end") {
        double x, y, angle;
        std::cin >> x >> y >> angle;
        Enki::PhysicalObject* object;
        if (kind == "robot") {
            robots.push_back(new Enki::Thymio2);
            object = robots.back();
        } else {
            double size_x, size_y, height, mass;
            std::cin >> size_x >> size_y >> height >> mass;
            object = new Enki::PhysicalObject;
            object->setRectangular(size_x, size_y, height, mass);
        }
        object->pos = Enki::Point(x, y);
        object->angle = angle;
        world.addObject(object);
    }
    uint32_t dice = 1;
    const auto target = [&dice] {  // the commands of benchmarks/lib/scenes.py
        dice = dice * 1664525u + 1013904223u;
        return static_cast<double>((dice >> 16) % 601) - 100.0;
    };
    for (unsigned steps; std::cin >> steps;) {
        for (auto* robot : robots) {
            robot->leftSpeed = target() * 16.6 / 500.0;
            robot->rightSpeed = target() * 16.6 / 500.0;
        }
        const double begun = seconds();
        for (unsigned step = 0; step < steps; ++step) world.step(0.03, 3);
        std::cout << seconds() - begun << std::endl;
    }
}
