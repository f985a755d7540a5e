// SPDX-License-Identifier: MIT
#include "cli/view_server.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "io/open_file.h"
#include "io/output_folder.h"
#include "io/text.h"
#include "topple/error.h"

namespace topple::cli {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
using boost::asio::ip::tcp;
using Request = http::request<http::string_body>;

constexpr const char* this_machine = "127.0.0.1";

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

// %41 is A. None: it is no such text.
std::optional<std::string> decoded(std::string_view text) {
    std::string out;
    for (std::size_t at = 0; at < text.size(); ++at) {
        out.push_back(text[at]);
        if (text[at] != '%') continue;
        const std::string_view digits = text.substr(at + 1, 2);
        unsigned char value = 0;
        const auto read = std::from_chars(digits.begin(), digits.end(), value, 16);
        if (digits.size() < 2 || read.ptr != digits.end()) return std::nullopt;
        out.back() = static_cast<char>(value);
        at += 2;
    }
    return out;
}

std::int64_t now_ms() {
    using namespace std::chrono;
    return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
}

// What lies in the folder that is served, and where it is served.
class Served {
  public:
    explicit Served(const std::filesystem::path& folder)
        : path_(std::filesystem::absolute(folder)), folder_(opened()) {
        if (folder_.get() < 0)
            io::fail(folder, std::string("can't be opened: ") + std::strerror(errno));
        output_ = output_there();
    }
    int folder() const { return folder_.get(); }
    std::int64_t since_ms() const { return since_ms_; }  // that this output is served

    // Takes what lies at the folder's path now, if that is another output.
    void look() {
        struct stat there {
        }, here{};
        if (stat(path_.c_str(), &there) == 0 && fstat(folder(), &here) == 0 &&
            (there.st_dev != here.st_dev || there.st_ino != here.st_ino)) {
            try {
                io::check_output(path_);
            } catch (const Error&) {
                return;  // the one that is served was the last
            }
            io::Descriptor next = opened();
            if (next.get() < 0) return;
            folder_ = std::move(next);
        }
        const Output now = output_there();
        if (now == output_ || now == Output{}) return;
        output_ = now;
        since_ms_ = now_ms();
    }

    std::string port;
    std::size_t listeners = 0;

  private:
    // An output's last file: by its device, inode and time.
    using Output = std::array<std::int64_t, 4>;

    io::Descriptor opened() const {
        return io::Descriptor(open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    }
    Output output_there() const {
        struct stat about {};
        if (fstatat(folder(), "scene.json", &about, AT_SYMLINK_NOFOLLOW) != 0) return {};
        return {static_cast<std::int64_t>(about.st_dev), static_cast<std::int64_t>(about.st_ino),
                about.st_mtim.tv_sec, about.st_mtim.tv_nsec};
    }

    std::filesystem::path path_;
    io::Descriptor folder_;
    Output output_{};
    std::int64_t since_ms_ = now_ms();
};

// One who listens to what is served, as long as that holds.
class Listener : public std::enable_shared_from_this<Listener> {
  public:
    static constexpr std::size_t most = 32;

    Listener(beast::tcp_stream stream, Served& served)
        : stream_(std::move(stream)), timer_(stream_.get_executor()), served_(served) {
        ++served_.listeners;
    }
    ~Listener() { --served_.listeners; }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    void begin() {
        say("HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\n"
            "X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n" +
            event());
    }

  private:
    std::string event() {
        told_ms_ = served_.since_ms();
        return "event: output\ndata: " + std::to_string(told_ms_) + "\n\n";
    }
    void say(std::string text) {
        text_ = std::move(text);
        silent_ = 0;
        stream_.expires_after(std::chrono::seconds(30));
        boost::asio::async_write(stream_, boost::asio::buffer(text_),
                                 [self = shared_from_this()](beast::error_code error, std::size_t) {
                                     if (!error) self->wait();
                                 });
    }
    void wait() {
        constexpr auto pause = std::chrono::milliseconds(200);
        constexpr int longest_silence = 75;  // pauses, until it is asked whether somebody listens
        timer_.expires_after(pause);
        timer_.async_wait([self = shared_from_this()](beast::error_code error) {
            if (error) return;
            if (self->told_ms_ != self->served_.since_ms()) return self->say(self->event());
            if (++self->silent_ >= longest_silence) return self->say(":\n\n");
            self->wait();
        });
    }

    beast::tcp_stream stream_;
    boost::asio::steady_timer timer_;
    Served& served_;
    std::string text_;
    std::int64_t told_ms_ = 0;
    int silent_ = 0;
};

// One connection: requests one after another, until it is idle for long or says that it ends.
class Session : public std::enable_shared_from_this<Session> {
  public:
    Session(tcp::socket socket, Served& served) : stream_(std::move(socket)), served_(served) {}

    void read() {
        parser_.emplace();
        parser_->body_limit(1024);  // of what nobody reads
        stream_.expires_after(std::chrono::seconds(30));
        http::async_read(stream_, buffer_, *parser_,
                         [self = shared_from_this()](beast::error_code error, std::size_t) {
                             if (!error) self->answer(self->parser_->release());
                         });
    }

  private:
    void answer(const Request& request) {
        const std::string_view host = as_text(request[http::field::host]);
        const std::string here = std::string(":") + served_.port;
        if (host != std::string(this_machine) + here && host != std::string("localhost") + here)
            return refuse(request, http::status::forbidden,
                          "This server answers to its own address only.");
        if (request.method() != http::verb::get && request.method() != http::verb::head)
            return refuse(request, http::status::method_not_allowed,
                          "Files are read here, and nothing else.");
        const std::string_view target = as_text(request.target());
        const auto path = decoded(target.substr(0, target.find_first_of("?#")));
        if (!path || !path->starts_with('/')) return not_found(request);
        if (*path == "/events" && request.method() == http::verb::get) return listen(request);
        send_file(request, *path == "/" ? "report.html" : path->substr(1));
    }

    void listen(const Request& request) {
        if (served_.listeners >= Listener::most)
            return refuse(request, http::status::service_unavailable, "Too many listen already.");
        std::make_shared<Listener>(std::move(stream_), served_)->begin();
    }

    void send_file(const Request& request, const std::string& name) {
        if (!plain_name(name)) return not_found(request);
        const int fd =
            openat(served_.folder(), name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
        if (fd < 0) return not_found(request);
        beast::file_posix file;
        file.native_handle(fd);  // which closes it
        struct stat about {};
        if (fstat(fd, &about) != 0 || !S_ISREG(about.st_mode)) return not_found(request);
        if (request.method() == http::verb::head) {
            http::response<http::empty_body> response;
            response.content_length(static_cast<std::uint64_t>(about.st_size));
            return send(request, std::move(response), media_type(name));
        }
        http::response<http::file_body> response;
        beast::error_code error;
        response.body().reset(std::move(file), error);
        if (error) return not_found(request);
        response.prepare_payload();
        send(request, std::move(response), media_type(name));
    }

    void not_found(const Request& request) {
        refuse(request, http::status::not_found, "There is no such file.");
    }

    void refuse(const Request& request, http::status status, const char* why) {
        http::response<http::string_body> response;
        response.result(status);
        response.body() = std::string(why) + "\n";
        response.prepare_payload();
        if (request.method() == http::verb::head) response.body().clear();
        send(request, std::move(response), "text/plain; charset=utf-8");
    }

    template <class Body>
    void send(const Request& request, http::response<Body> made, const char* type) {
        const auto response = std::make_shared<http::response<Body>>(std::move(made));
        response->version(request.version());
        response->keep_alive(request.keep_alive());
        response->set(http::field::content_type, type);
        response->set(http::field::cache_control, "no-store");
        response->set("X-Content-Type-Options", "nosniff");
        stream_.expires_after(std::chrono::minutes(10));
        http::async_write(
            stream_, *response,
            [self = shared_from_this(), response](beast::error_code error, std::size_t) {
                if (!error && response->keep_alive()) return self->read();
                self->stream_.socket().shutdown(tcp::socket::shutdown_send, error);
            });
    }

    static std::string_view as_text(beast::string_view text) { return {text.data(), text.size()}; }

    beast::tcp_stream stream_;
    beast::flat_buffer buffer_{1 << 16};
    std::optional<http::request_parser<http::string_body>> parser_;
    Served& served_;
};

}  // namespace

struct ViewServer::Inner {
    explicit Inner(const std::filesystem::path& folder) : served(folder) {}
    void accept() {
        acceptor.async_accept([this](beast::error_code error, tcp::socket socket) {
            if (!error) std::make_shared<Session>(std::move(socket), served)->read();
            accept();
        });
    }

    Served served;  // outlives the sessions
    boost::asio::io_context context{1};
    tcp::acceptor acceptor{context};
};

ViewServer::ViewServer(const std::filesystem::path& folder, std::uint16_t port)
    : inner_(std::make_unique<Inner>(folder)) {
    Served& served = inner_->served;
    tcp::acceptor& acceptor = inner_->acceptor;
    beast::error_code error;
    acceptor.open(tcp::v4(), error);
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind({boost::asio::ip::make_address(this_machine), port}, error);
    if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
    if (error) {
        throw Error(ErrorKind::usage, std::string("--port ") + std::to_string(port) +
                                          ": can't be taken (" + error.message() +
                                          "); leave it out for one that is free");
    }
    served.port = std::to_string(acceptor.local_endpoint().port());
    inner_->accept();
}

ViewServer::~ViewServer() = default;

std::string ViewServer::url() const {
    return std::string("http://") + this_machine + ":" + inner_->served.port + "/";
}

void ViewServer::run(const std::function<bool()>& done) {
    while (!done()) {
        inner_->served.look();
        inner_->context.run_for(std::chrono::milliseconds(100));
    }
}

}  // namespace topple::cli
