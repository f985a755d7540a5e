// SPDX-License-Identifier: MIT
// labels_in_place SCAN: parses points that lie in the program's own records, without a copy, and
// writes what they belong to into these records.
#include <cstdint>
#include <cstdio>
#include <thread>
#include <vector>

#include "topple/parse.h"
#include "topple/stages.h"

struct Record {
    float x, y, z;
    std::int32_t object;
};

// The points of a scan, as another program might have them.
std::vector<Record> records_of(const char* scan) {
    topple::ParseOptions options;
    options.disturbances = {};
    const topple::ScenePoints points = topple::parse(scan, options).scene.points;
    std::vector<Record> records;
    for (std::size_t i = 0; i < points.x.size(); ++i)
        records.push_back({points.x[i], points.y[i], points.z[i], -1});
    return records;
}

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    try {
        std::vector<Record> records = records_of(argv[1]);
        const auto cloud =
            topple::CloudView::of_records(&records[0].x, records.size(), sizeof(Record));
        topple::ParseOptions options;
        options.device = topple::device::open_device("native");
        options.coordinates = false;  // they are here already
        options.progress = [last = std::string()](const std::string& stage, double) mutable {
            if (stage != last) std::fprintf(stderr, "%s\n", stage.c_str());
            last = stage;
        };
        const topple::ParseResult result = topple::parse(cloud, options);
        for (std::size_t i = 0; i < records.size(); ++i)
            records[i].object = result.scene.points.object[i];
        std::printf("%zu objects of %zu points\n", result.scene.objects.size(), records.size());

        // One stage by itself, on the same points and device.
        std::vector<float> nx(records.size()), ny = nx, nz = nx;
        const double cell_m = 2 * topple::stages::point_spacing(cloud);
        topple::stages::normals(*options.device, cloud, cell_m, nullptr, nx, ny, nz);
        std::printf("the first point's normal is (%.2f, %.2f, %.2f)\n", nx[0], ny[0], nz[0]);
    } catch (const topple::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
