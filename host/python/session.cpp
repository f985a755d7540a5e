// SPDX-License-Identifier: MIT
#include "topple/session.h"

#include <chrono>
#include <optional>

#include "arrays.h"
#include "busy.h"
#include "stopped.h"

// Scans that are still being made. Tuples, which topple/_session.py names.
namespace topple::python {
namespace {

class PySession {
  public:
    PySession(const std::array<std::uint32_t, 2>& size, const std::array<double, 5>& camera,
              const std::shared_ptr<SharedDevice>& device, ParseOptions options, bool forget_gone,
              std::uint64_t max_frame_bytes)
        : session_(intrinsics(size[0], size[1], camera), std::nullopt,
                   session_options(device, std::move(options), forget_gone, max_frame_bytes)) {}
    PySession(const std::shared_ptr<SharedDevice>& device, ParseOptions options, bool forget_gone,
              std::uint64_t max_frame_bytes)
        : session_(Session::of_points(
              session_options(device, std::move(options), forget_gone, max_frame_bytes))) {}
    PySession(const std::string& checkpoint, const std::shared_ptr<SharedDevice>& device,
              ParseOptions options, bool forget_gone, std::uint64_t max_frame_bytes)
        : session_(unlocked([&] {
              return Session::resume(checkpoint, session_options(device, std::move(options),
                                                                 forget_gone, max_frame_bytes));
          })) {}
    void checkpoint(const std::string& file) const {
        unlocked([&] { session_.checkpoint(file); });
    }
    FrameId add(const PyFrame& frame, const py::array& pose) {
        const FramesView view = seen(frame, pose);
        return unlocked([&] { return session_.add(view.images[0], view.camera_to_world[0]); });
    }
    FrameId add_points(const std::vector<py::array>& points, const std::vector<py::array>& colours,
                       const py::array& pose) {
        const CloudView view = view_of(points, {}, colours, {});
        const Mat4 to_world = mat4(pose);
        return unlocked([&] { return session_.add(view, to_world); });
    }
    void correct(const std::vector<FrameId>& frames, const py::array& poses) {
        const auto numbers = row<const double>(poses, "camera_to_world");
        std::map<FrameId, Mat4> given;
        for (std::size_t n = 0; n < frames.size(); ++n)
            std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(16 * n), 16,
                        given[frames[n]].begin());
        unlocked([&] { session_.correct(given); });
    }
    py::tuple label(const PyFrame& frame, const py::array& pose) const {
        const FramesView view = seen(frame, pose);
        ThingLabels found =
            unlocked([&] { return session_.label(view.images[0], view.camera_to_world[0]); });
        return py::make_tuple(found.height, found.width, owned(std::move(found.thing)));
    }
    py::array label_points(const std::vector<py::array>& points, const py::array& pose) const {
        const CloudView view = view_of(points, {}, {}, {});
        const Mat4 to_world = mat4(pose);
        return owned(unlocked([&] { return session_.label(view, to_world); }));
    }
    bool is_of_points() const { return !session_.intrinsics(); }
    py::object update(std::optional<std::uint64_t> budget_ms) {
        return described(stoppable([&] {
            return budget_ms ? session_.update(std::chrono::milliseconds(*budget_ms))
                             : session_.update();
        }));
    }
    py::list glance() const {
        py::list out;
        for (const Appeared& one : unlocked([&] { return session_.glance(); }))
            out.append(py::make_tuple(one.middle_m, one.size_m, one.mass_kg, one.mass_error_kg,
                                      one.stands_on, one.barrier_J, one.barrier_error_J,
                                      one.release_J, one.mode, one.risk_J, one.fall_chance,
                                      one.unsafety_category));
        return out;
    }
    void write(const std::string& folder) const {
        const auto found = session_.scene();
        if (!found) throw Error(ErrorKind::usage, "session: nothing is known before update()");
        unlocked([&] { write_outputs(*found, folder); });
    }
    std::shared_ptr<Parsed> settle() {
        return parsed(*stoppable([&] { return session_.settle(); }));
    }
    py::object scene() const { return described(session_.scene()); }
    void cancel() {
        unlocked([&] { session_.cancel(); });
    }
    Session& session() { return session_; }

  private:
    static Mat4 mat4(const py::array& pose) {
        Mat4 out;
        std::ranges::copy(row<const double>(pose, "sensor_to_world"), out.begin());
        return out;
    }
    static SessionOptions session_options(const std::shared_ptr<SharedDevice>& device,
                                          ParseOptions options, bool forget_gone,
                                          std::uint64_t max_frame_bytes) {
        if (device) options.device = device->here();
        // What goes on behind is no thread of Python's, and gets no signals.
        options.cancelled = [stopped = Stopped()] {
            return Busy::here() ? stopped() : Busy::must_stop();
        };
        return {std::move(options), forget_gone, max_frame_bytes};
    }
    FramesView seen(const PyFrame& frame, const py::array& pose) const {
        const std::array<std::uint32_t, 2> size{static_cast<std::uint32_t>(frame.first.shape(1)),
                                                static_cast<std::uint32_t>(frame.first.shape(0))};
        const Intrinsics k = session_.intrinsics().value_or(Intrinsics{});  // whose add() refuses
        return frames_view({frame}, size, pose, {k.fx, k.fy, k.cx, k.cy, k.depth_scale}, "frame");
    }
    static std::shared_ptr<Parsed> parsed(const ParseResult& result) {
        auto out = std::make_shared<Parsed>();
        out->result = result;
        return out;
    }
    static py::object described(const std::shared_ptr<const LiveScene>& found) {
        if (!found) return py::none();
        py::list things;
        for (const Thing& thing : found->things)
            things.append(
                py::make_tuple(thing.id, thing.object, to_string(thing.change), thing.moved_m));
        return py::make_tuple(parsed(*found->result), things, found->frames, found->number,
                              found->current);
    }
    Session session_;
};

}  // namespace

void bind_session(py::module_& module) {
    py::class_<PySession>(module, "Session")
        .def(py::init<const std::array<std::uint32_t, 2>&, const std::array<double, 5>&,
                      const std::shared_ptr<SharedDevice>&, ParseOptions, bool, std::uint64_t>())
        .def(py::init<const std::shared_ptr<SharedDevice>&, ParseOptions, bool, std::uint64_t>())
        .def(py::init<const std::string&, const std::shared_ptr<SharedDevice>&, ParseOptions, bool,
                      std::uint64_t>())
        .def("checkpoint", &PySession::checkpoint)
        .def("add", &PySession::add)
        .def("add_points", &PySession::add_points)
        .def("is_of_points", &PySession::is_of_points)
        .def("correct", &PySession::correct)
        .def("forget", [](PySession& s, FrameId frame) { s.session().forget(frame); })
        .def("frames", [](PySession& s) { return s.session().frames(); })
        .def("frame_bytes", [](PySession& s) { return s.session().frame_bytes(); })
        .def("update", &PySession::update)
        .def("glance", &PySession::glance)
        .def("write", &PySession::write)
        .def("settle", &PySession::settle)
        .def("cancel", &PySession::cancel)
        .def("scene", &PySession::scene)
        .def("label", &PySession::label)
        .def("label_points", &PySession::label_points);
}

}  // namespace topple::python
