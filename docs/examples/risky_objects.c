/* SPDX-License-Identifier: MIT
 * risky_objects SCAN: what is in a scan, and what may fall in a storm; and one stage by itself, on
 * records of the program's own.
 *   cc risky_objects.c $(pkg-config --cflags --libs topple) -o risky_objects */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <topple/topple.h>

static void on_progress(const char* stage, double done, void* user) {
    if (done == 0 && strcmp(stage, (const char*)user) != 0)
        fprintf(stderr, "%s\n", stage);
}

/* Prints the objects that are most at risk; their number. */
static uint64_t print_objects(const topple_result* result) {
    topple_scene scene = {.size = sizeof(scene)};
    topple_result_scene(result, &scene, NULL);
    for (uint64_t n = 0; n < scene.objects; ++n) {
        topple_object object = {.size = sizeof(object)};
        topple_result_object(result, n, &object, NULL);
        if (!(object.unsafety > 7)) continue;
        double risk_J = 0;
        topple_result_risk(result, n, "wind", &risk_J, NULL, NULL);
        printf("object %d: %.2f J per storm. %s\n", object.id, risk_J, object.why);
    }
    printf("%llu objects of %llu points on %s\n", (unsigned long long)scene.objects,
           (unsigned long long)scene.points, scene.backend);
    return scene.objects;
}

/* A tilted floor, as records of x, y, z and a colour: normals of it, by one stage alone. */
struct record {
    float x, y, z;
    unsigned char colour[4];
};
static struct record floor_points[100 * 100];

static int normals_of_records(topple_status* status) {
    enum { side = 100, count = side * side };
    for (int n = 0; n < count; ++n) {
        struct record* p = &floor_points[n];
        p->x = 0.02f * (float)(n % side);
        p->y = 0.02f * (float)(n / side);
        p->z = 0.75f * p->x;
    }
    topple_cloud cloud;
    topple_cloud_init(&cloud, sizeof(cloud));
    cloud.x = &floor_points[0].x;
    cloud.y = &floor_points[0].y;
    cloud.z = &floor_points[0].z;
    cloud.count = count;
    cloud.stride_bytes = sizeof(struct record);
    topple_device* device = NULL;
    if (topple_device_open("auto", 0, &device, status) != TOPPLE_OK) return 0;
    float* normals = malloc(3 * count * sizeof(float));
    const double eye[3] = {1, 1, 3};
    const int done = normals && topple_normals(device, &cloud, 0.04, eye, normals, normals + count,
                                               normals + 2 * count, status) == TOPPLE_OK;
    if (done) {
        const int middle = count / 2 + side / 2;
        printf("the floor's normal is (%.2f, %.2f, %.2f)\n", normals[middle],
               normals[count + middle], normals[2 * count + middle]);
    }
    free(normals);
    topple_device_release(device);
    return done;
}

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    topple_status status;
    topple_options options;
    topple_options_init(&options, sizeof(options));
    options.disturbances = TOPPLE_WIND;
    options.wind_m_s = 20;
    options.progress = on_progress;
    options.user = "ingest"; /* not worth a line */
    topple_result* result = NULL;
    if (topple_parse(argv[1], &options, &result, &status) != TOPPLE_OK) {
        fprintf(stderr, "%s\n", status.message);
        return 1;
    }
    print_objects(result);
    topple_result_release(result);

    if (!normals_of_records(&status)) {
        fprintf(stderr, "%s\n", status.message);
        return 1;
    }
    return 0;
}
