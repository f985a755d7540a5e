// SPDX-License-Identifier: MIT
#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include "arrays.h"
#include "busy.h"
#include "core/number_options.h"

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
        if (progress_.is_none() || !mine() || stop_) return;
        if (stage == stage_ && done != 1 && !due(told_)) return;
        stage_ = stage;
        ask([&] { progress_(stage, done); });
    }
    // What may be worth an end before the parse's own, as poses that make nonsense.
    void notice(const std::string& line) {
        if (!mine() || stop_) return;
        ask([&] { py::module_::import("topple._arrays").attr("warn")(line); });
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
    std::string stage_;  // that was told last
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
    options.notice = [&](const std::string& line) { caller.notice(line); };
    if (device) options.device = device->here();
    auto out = std::make_shared<Parsed>();
    try {
        out->result = unlocked([&] { return parse_with(options); });
    } catch (const Error&) {
        caller.rethrow();
        throw;
    }
    caller.rethrow();
    return out;
}

// frames: all of them; or none, and `load` gives that of a number.
std::shared_ptr<Parsed> parse_frames(const std::vector<PyFrame>& frames, const py::object& load,
                                     const std::array<std::uint32_t, 2>& size,
                                     const py::array& poses, const std::array<double, 5>& camera,
                                     const std::optional<std::array<double, 5>>& colour_camera,
                                     const std::string& name,
                                     const std::shared_ptr<SharedDevice>& device,
                                     const ParseOptions& options, py::object progress,
                                     py::object cancelled) {
    FramesView view = frames_view(frames, size, poses, camera, name);
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
    return run(device, options, std::move(progress), std::move(cancelled),
               [&](const ParseOptions& o) { return parse(view, o); });
}

}  // namespace

void bind_parse(py::module_& module) {
    py::class_<ParseOptions> bound(module, "Options");
    for (const NumberOption& option : number_options) {
        const std::string words = option.words, name = words.substr(0, words.find(' '));
        std::visit([&](auto member) { bound.def_readwrite(name.c_str(), member); }, option.member);
    }
    bound.def(py::init<>())
        .def_readwrite("up", &ParseOptions::up)
        .def_readwrite("disturbances", &ParseOptions::disturbances)
        .def_readwrite("people", &ParseOptions::people)
        .def_readwrite("isolate", &ParseOptions::isolate)
        .def_readwrite("space_fields", &ParseOptions::space_fields)
        .def_readwrite("seed", &ParseOptions::seed)
        .def_readwrite("max_memory_bytes", &ParseOptions::max_memory_bytes)
        .def_readwrite("walks", &ParseOptions::walks)
        .def("read_motion",
             [](ParseOptions& o, const std::string& file, const std::optional<double>& unit_m,
                const std::optional<double>& rate_hz, const std::optional<Vec3>& up) {
                 o.motions.push_back(
                     std::make_shared<BodyMotion>(read_motion(file, {unit_m, rate_hz, up})));
             })
        .def("read_accelerogram",
             [](ParseOptions& o, const std::string& along, const std::optional<std::string>& across,
                const std::optional<std::string>& up, const std::optional<std::string>& unit) {
                 std::optional<double> unit_m_s2;
                 if (unit) unit_m_s2 = acceleration_unit_m_s2(*unit);
                 o.accelerogram = read_accelerogram(along, across, up, unit_m_s2);
             })
        .def("read_corrections",
             [](ParseOptions& o, const std::string& file) {
                 o.corrections = read_corrections(file);
             })
        .def("take_corrections",
             [](ParseOptions& o, const std::string& json) { o.corrections = corrections_of(json); })
        .def("set_cache_file",
             [](ParseOptions& o, const std::string& file) { o.cache_file = file; })
        .def("read_materials",
             [](ParseOptions& o, const std::string& file) {
                 o.materials = std::make_shared<const Materials>(read_materials(file));
             })
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
                   see_from(viewpoints, view);
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
        // First, but after that nothing was judged.
        const bool judged =
            scene.notes.empty() || !scene.notes[0].starts_with("Nothing was judged");
        scene.notes.insert(scene.notes.begin() + (judged ? 0 : 1), notes.begin(), notes.end());
        for (std::size_t axis = 0; axis < 3; ++axis) scene.offset_m[axis] += offset_m[axis];
    });
    module.def("load", [](const std::string& folder) {
        auto out = std::make_shared<Parsed>();
        out->result = unlocked([&] { return read_outputs(folder); });
        return out;
    });
    module.def("write",
               [](Parsed& parsed, const std::string& folder, bool pictures, bool glb, bool octomap,
                  const std::vector<py::array>& points, const std::vector<py::array>& colours) {
                   const std::optional<CloudView> view = caller_points(points, colours);
                   OutputOptions options;
                   options.pictures = pictures;
                   options.glb = glb;
                   options.octomap = octomap;
                   options.cancelled = Busy::must_stop;
                   unlocked([&] {
                       const LentCoordinates lent(view, parsed);
                       write_outputs(parsed.result, folder, options);
                   });
               });
}

}  // namespace topple::python
