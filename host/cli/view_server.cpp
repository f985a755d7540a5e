// SPDX-License-Identifier: MIT
#include "cli/view_server.h"

#include <fcntl.h>
#include <httplib.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <string_view>
#include <thread>

#include "io/text.h"
#include "topple/error.h"

namespace topple::cli {
namespace {

constexpr const char* this_machine = "127.0.0.1";

class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor() {
        if (fd_ >= 0) close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return fd_; }

  private:
    int fd_;
};

const char* media_type(std::string_view name) {
    const auto dot = name.rfind('.');
    const std::string_view ending = dot == std::string_view::npos ? "" : name.substr(dot);
    if (ending == ".html") return "text/html; charset=utf-8";
    if (ending == ".json") return "application/json";
    if (ending == ".png") return "image/png";
    if (ending == ".glb") return "model/gltf-binary";
    return "application/octet-stream";
}

// Of a file of the folder itself. None of these needs a look at what lies where.
bool plain_name(std::string_view name) {
    return !name.empty() && name.front() != '.' && std::ranges::none_of(name, [](char c) {
        return c == '/' || c == '\\' || static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    });
}

void refuse(httplib::Response& response, int status, const char* why) {
    response.status = status;
    response.set_content(std::string(why) + "\n", "text/plain; charset=utf-8");
}

}  // namespace

struct ViewServer::Inner {
    explicit Inner(int fd) : folder(fd) {}

    void answer(const httplib::Request& request, httplib::Response& response) const {
        response.set_header("Cache-Control", "no-store");
        response.set_header("X-Content-Type-Options", "nosniff");
        const std::string host = request.get_header_value("Host"),
                          here = std::string(":") + std::to_string(port);
        if (host != std::string(this_machine) + here && host != std::string("localhost") + here)
            return refuse(response, 403, "This server answers to its own address only.");
        if (request.method != "GET" && request.method != "HEAD")
            return refuse(response, 405, "Files are read here, and nothing else.");
        const std::string name = request.path == "/" ? "report.html" : request.path.substr(1);
        if (!plain_name(name)) return refuse(response, 404, "There is no such file.");
        const auto file = std::make_shared<Descriptor>(
            openat(folder.get(), name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
        struct stat about {};
        if (file->get() < 0 || fstat(file->get(), &about) != 0 || !S_ISREG(about.st_mode))
            return refuse(response, 404, "There is no such file.");
        if (about.st_size == 0) return response.set_content("", media_type(name));
        response.set_content_provider(
            static_cast<std::size_t>(about.st_size), media_type(name),
            [file](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                std::vector<char> bytes(std::min<std::size_t>(length, 1 << 18));
                const ssize_t got =
                    pread(file->get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
                // What was cut short meanwhile ends the connection, not the file.
                return got > 0 && sink.write(bytes.data(), static_cast<std::size_t>(got));
            });
    }

    Descriptor folder;
    int port = 0;
    httplib::Server server;
};

ViewServer::ViewServer(const std::filesystem::path& folder, std::uint16_t port) {
    const int fd = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0) io::fail(folder, std::string("can't be opened: ") + std::strerror(errno));
    inner_ = std::make_unique<Inner>(fd);
    httplib::Server& server = inner_->server;
    server.set_keep_alive_timeout(1);  // seconds: an idle connection must not hold up the end
    // The library's own choice shares a port with whoever else has it.
    server.set_socket_options([](socket_t socket) {
        const int yes = 1;
        setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    });
    server.set_pre_routing_handler([inner = inner_.get()](const auto& request, auto& response) {
        inner->answer(request, response);
        return httplib::Server::HandlerResponse::Handled;
    });
    if (port == 0) {
        inner_->port = server.bind_to_any_port(this_machine);
        if (inner_->port <= 0)
            throw Error(ErrorKind::usage, "no port of 127.0.0.1 can be taken; give a --port");
    } else if (server.bind_to_port(this_machine, port)) {
        inner_->port = port;
    } else {
        throw Error(ErrorKind::usage, std::string("--port ") + std::to_string(port) +
                                          ": can't be taken, as another program has it or it is "
                                          "the system's; leave it out for one that is free");
    }
}

ViewServer::~ViewServer() = default;

std::string ViewServer::url() const {
    return "http://" + std::string(this_machine) + ":" + std::to_string(inner_->port) + "/";
}

void ViewServer::run(const std::function<bool()>& done) {
    using namespace std::chrono_literals;
    std::atomic<bool> ended = false;
    std::thread serving([&] {
        inner_->server.listen_after_bind();
        ended = true;
    });
    while (!ended && !(inner_->server.is_running() && done())) std::this_thread::sleep_for(100ms);
    inner_->server.stop();
    serving.join();
}

}  // namespace topple::cli
