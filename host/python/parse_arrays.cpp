// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <limits>
#include <thread>

#include "arrays.h"
#include "busy.h"

namespace topple::python {
namespace {

using Clock = std::chrono::steady_clock;

// Python's side of a running parse, which holds no lock of the interpreter: it is asked now and
// then, on the thread that called.
class Caller {
  public:
    Caller(py::object progress, py::object cancelled)
        : progress_(std::move(progress)), cancelled_(std::move(cancelled)) {}

    void progress(const std::string& stage, double done) {
        if (progress_.is_none() || !mine() || stop_ || (done != 0 && done != 1 && !due(told_)))
            return;
        ask([&] { progress_(stage, done); });
    }
    // Whether it was told to stop, by the callback or by a signal such as Ctrl-C.
    bool cancelled() {
        if (!stop_ && mine() && due(asked_)) {
            ask([&] {
                if (PyErr_CheckSignals() != 0) throw py::error_already_set();
                if (!cancelled_.is_none() && cancelled_().cast<bool>()) stop_ = true;
            });
        }
        return stop_ || Busy::must_stop();
    }
    // With the interpreter's lock: throws what a callback or a signal has thrown.
    void rethrow() {
        if (thrown_) throw *thrown_;
    }

  private:
    bool mine() const { return std::this_thread::get_id() == thread_; }
    static bool due(Clock::time_point& last) {
        const Clock::time_point now = Clock::now();
        if (now - last < std::chrono::milliseconds(50)) return false;
        last = now;
        return true;
    }
    template <class Question>
    void ask(const Question& question) {
        const py::gil_scoped_acquire acquire;
        try {
            question();
        } catch (py::error_already_set& error) {
            thrown_ = std::make_unique<py::error_already_set>(std::move(error));
            stop_ = true;
        } catch (const py::cast_error&) {
            PyErr_SetString(PyExc_TypeError, "cancelled() must return a bool");
            thrown_ = std::make_unique<py::error_already_set>();
            stop_ = true;
        }
    }

    py::object progress_, cancelled_;
    const std::thread::id thread_ = std::this_thread::get_id();
    std::atomic<bool> stop_ = false;
    Clock::time_point told_{}, asked_{};
    std::unique_ptr<py::error_already_set> thrown_;
};

template <class Parse>
std::shared_ptr<Parsed> run(const std::shared_ptr<SharedDevice>& device, ParseOptions options,
                            py::object progress, py::object cancelled, const Parse& parse_with) {
    Caller caller(std::move(progress), std::move(cancelled));
    options.progress = [&](const std::string& stage, double done) { caller.progress(stage, done); };
    options.cancelled = [&] { return caller.cancelled(); };
    std::unique_lock<std::mutex> lock;
    if (device) {
        lock = std::unique_lock(device->in_use, std::try_to_lock);
        if (!lock)
            throw Error(ErrorKind::usage,
                        "the device is in use by another thread's parse; open one for each");
        options.device = device->device;
    }
    auto out = std::make_shared<Parsed>();
    try {
        const Busy busy;
        const py::gil_scoped_release release;
        out->result = parse_with(options);
    } catch (const Error&) {
        caller.rethrow();
        throw;
    }
    caller.rethrow();
    return out;
}

// A one-dimensional array where it lies.
template <class T>
Column<T> column(const py::array& from, const char* name) {
    if (from.ndim() != 1 || !py::isinstance<py::array_t<T>>(from)) {
        throw Error(ErrorKind::usage, std::string(name) + " is no array of " +
                                          (sizeof(T) == 1 ? "uint8" : "float32") + " in a row");
    }
    return {static_cast<const T*>(from.data()), static_cast<std::size_t>(from.shape(0)),
            from.strides(0)};
}

// An image where it lies; the Python side has seen to its type and to rows without gaps.
template <class Pixel, class Value>
ImageView<Pixel> image(const py::array& from, const char* name) {
    const py::ssize_t values = sizeof(Pixel) / sizeof(Value);
    const bool fits =
        py::isinstance<py::array_t<Value>>(from) && from.ndim() == (values == 1 ? 2 : 3) &&
        (values == 1 || (from.shape(2) == values && from.strides(2) == sizeof(Value)));
    if (!fits || (from.shape(1) > 1 && from.strides(1) != sizeof(Pixel)) ||
        std::max(from.shape(0), from.shape(1)) > std::numeric_limits<std::int32_t>::max())
        throw Error(ErrorKind::usage, std::string(name) + " is no image with rows without gaps");
    return {static_cast<const Pixel*>(from.data()), static_cast<std::uint32_t>(from.shape(1)),
            static_cast<std::uint32_t>(from.shape(0)), from.shape(0) > 1 ? from.strides(0) : 0};
}

using PyFrame = std::pair<py::array, std::optional<py::array>>;  // depth, colour

FrameView frame_view(const PyFrame& frame) {
    FrameView out;
    if (py::isinstance<py::array_t<float>>(frame.first))
        out.depth_m = image<float, float>(frame.first, "frames");
    else
        out.depth = image<std::uint16_t, std::uint16_t>(frame.first, "frames");
    if (frame.second) out.colour = image<Rgb, std::uint8_t>(*frame.second, "colours");
    return out;
}

// frames: all of them; or none, and `load` gives that of a number. size: width and height. poses:
// 16 numbers each. Cameras: fx, fy, cx, cy, depth_scale.
std::shared_ptr<Parsed> parse_frames(const std::vector<PyFrame>& frames, const py::object& load,
                                     const std::array<std::uint32_t, 2>& size,
                                     const py::array& poses, const std::array<double, 5>& camera,
                                     const std::optional<std::array<double, 5>>& colour_camera,
                                     const std::string& name,
                                     const std::shared_ptr<SharedDevice>& device,
                                     const ParseOptions& options, py::object progress,
                                     py::object cancelled) {
    const auto intrinsics = [](std::uint32_t width, std::uint32_t height,
                               const std::array<double, 5>& c) {
        return Intrinsics{width, height, c[0], c[1], c[2], c[3], c[4]};
    };
    FramesView view;
    view.source = name;
    view.intrinsics = intrinsics(size[0], size[1], camera);
    for (const PyFrame& frame : frames) view.images.push_back(frame_view(frame));
    PyFrame last;  // stays until the next one is asked for
    if (frames.empty()) {
        view.image = [&](std::size_t number) {
            const py::gil_scoped_acquire acquire;
            last = load(number).cast<PyFrame>();
            return frame_view(last);
        };
    }
    if (colour_camera) {
        // Theirs is the size of the first that there is.
        const PyFrame* first = nullptr;
        for (const PyFrame& frame : frames)
            if (frame.second && !first) first = &frame;
        if (frames.empty()) last = load(0).cast<PyFrame>();
        if (frames.empty() && last.second) first = &last;
        if (first)
            view.colour_intrinsics =
                intrinsics(static_cast<std::uint32_t>(first->second->shape(1)),
                           static_cast<std::uint32_t>(first->second->shape(0)), *colour_camera);
    }
    const std::span<const double> values = row<const double>(poses, "camera_to_world");
    for (std::size_t at = 0; at + 16 <= values.size(); at += 16)
        std::ranges::copy(values.subspan(at, 16), view.camera_to_world.emplace_back().begin());
    return run(device, options, std::move(progress), std::move(cancelled),
               [&](const ParseOptions& o) { return parse(view, o); });
}

}  // namespace

CloudView view_of(const std::vector<py::array>& points, const std::vector<py::array>& normals,
                  const std::vector<py::array>& colours, const std::optional<Vec3>& viewpoint) {
    CloudView view;
    view.source = "points";
    view.x = column<float>(points.at(0), "x");
    view.y = column<float>(points.at(1), "y");
    view.z = column<float>(points.at(2), "z");
    if (!normals.empty()) {
        view.nx = column<float>(normals.at(0), "nx");
        view.ny = column<float>(normals.at(1), "ny");
        view.nz = column<float>(normals.at(2), "nz");
    }
    if (!colours.empty()) {
        view.red = column<std::uint8_t>(colours.at(0), "red");
        view.green = column<std::uint8_t>(colours.at(1), "green");
        view.blue = column<std::uint8_t>(colours.at(2), "blue");
    }
    view.has_viewpoint = viewpoint.has_value();
    view.viewpoint = viewpoint.value_or(Vec3{});
    return view;
}

void bind_parse(py::module_& module) {
    py::class_<ParseOptions>(module, "Options")
        .def(py::init<>())
        .def_readwrite("voxel_m", &ParseOptions::voxel_m)
        .def_readwrite("unit_m", &ParseOptions::unit_m)
        .def_readwrite("up", &ParseOptions::up)
        .def_readwrite("disturbances", &ParseOptions::disturbances)
        .def_readwrite("isolate", &ParseOptions::isolate)
        .def_readwrite("seed", &ParseOptions::seed)
        .def_readwrite("tile_m", &ParseOptions::tile_m)
        .def_readwrite("max_memory_bytes", &ParseOptions::max_memory_bytes)
        .def_readwrite("density_kg_m3", &ParseOptions::density_kg_m3)
        .def_readwrite("friction", &ParseOptions::friction)
        .def_readwrite("contents_kg_m3", &ParseOptions::contents_kg_m3)
        .def_readwrite("walks", &ParseOptions::walks)
        .def_readwrite("wind_m_s", &ParseOptions::wind_m_s)
        .def_readwrite("wind_from_deg", &ParseOptions::wind_from_deg)
        .def_readwrite("pga_m_s2", &ParseOptions::pga_m_s2)
        .def_readwrite("floor_amplification", &ParseOptions::floor_amplification)
        .def_readwrite("tolerable_J", &ParseOptions::tolerable_J)
        .def_readwrite("grouping_time_s", &ParseOptions::grouping_time_s)
        .def("read_motion",
             [](ParseOptions& o, const std::string& file) {
                 o.motions.push_back(std::make_shared<BodyMotion>(read_motion(file)));
             })
        .def("read_accelerogram",
             [](ParseOptions& o, const std::string& along, const std::optional<std::string>& across,
                const std::optional<std::string>& up) {
                 o.accelerogram = read_accelerogram(along, across, up);
             })
        .def("read_corrections",
             [](ParseOptions& o, const std::string& file) {
                 o.corrections = read_corrections(file);
             })
        .def("take_corrections",
             [](ParseOptions& o, const std::string& json) { o.corrections = corrections_of(json); })
        .def("set_cache_file",
             [](ParseOptions& o, const std::string& file) { o.cache_file = file; })
        .def("read_hazard_curve",
             [](ParseOptions& o, const std::string& file) { o.hazard = read_hazard_curve(file); });
    module.def(
        "parse_path", [](const std::string& path, const std::shared_ptr<SharedDevice>& device,
                         const ParseOptions& options, py::object progress, py::object cancelled) {
            return run(
                device, options, std::move(progress), std::move(cancelled),
                [&](const ParseOptions& o) { return parse(std::filesystem::path(path), o); });
        });
    // The arrays are read without the interpreter's lock: nobody may write to them meanwhile.
    module.def("parse_arrays",
               [](const std::vector<py::array>& points, const std::vector<py::array>& normals,
                  const std::vector<py::array>& colours, const std::optional<Vec3>& viewpoint,
                  const std::vector<py::array>& viewpoints, const std::string& name,
                  const std::shared_ptr<SharedDevice>& device, ParseOptions options,
                  py::object progress, py::object cancelled) {
                   CloudView view = view_of(points, normals, colours, viewpoint);
                   if (!viewpoints.empty()) {
                       view.viewpoint_x = column<float>(viewpoints.at(0), "viewpoint x");
                       view.viewpoint_y = column<float>(viewpoints.at(1), "viewpoint y");
                       view.viewpoint_z = column<float>(viewpoints.at(2), "viewpoint z");
                   }
                   view.source = name;
                   options.coordinates = false;
                   return run(device, options, std::move(progress), std::move(cancelled),
                              [&](const ParseOptions& o) { return parse(view, o); });
               });
    module.def("parse_frames", parse_frames);
    // Of a scan that was parsed from a copy in another format.
    module.def("came_from", [](Parsed& parsed, const std::string& source,
                               const std::vector<std::string>& notes, const Vec3& offset_m) {
        Scene& scene = parsed.result.scene;
        scene.source = source;
        scene.notes.insert(scene.notes.begin(), notes.begin(), notes.end());
        for (std::size_t axis = 0; axis < 3; ++axis) scene.offset_m[axis] += offset_m[axis];
    });
    module.def("write",
               [](Parsed& parsed, const std::string& folder, bool pictures, bool glb, bool octomap,
                  const std::vector<py::array>& points, const std::vector<py::array>& colours) {
                   std::optional<CloudView> view;
                   if (!points.empty()) view = view_of(points, {}, colours, {});
                   const Busy busy;
                   const py::gil_scoped_release release;
                   ScenePoints& kept = parsed.result.scene.points;
                   if (view) add_coordinates(*view, parsed.result);
                   struct Forget {
                       ScenePoints* points;
                       ~Forget() {
                           if (!points) return;
                           points->x = points->y = points->z = {};
                           points->red = points->green = points->blue = {};
                       }
                   } const forget{view ? &kept : nullptr};
                   OutputOptions options;
                   options.pictures = pictures;
                   options.glb = glb;
                   options.octomap = octomap;
                   options.cancelled = Busy::must_stop;
                   write_outputs(parsed.result, folder, options);
               });
}

}  // namespace topple::python
