// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "io/text.h"
#include "points/formats/frame_sequence.h"
#include "points/formats/rigid_pose.h"

// Poses of cameras as TUM, KITTI and Open3D write them.
namespace topple::io {
namespace {

// Camera to world from a position and a unit quaternion.
Mat4 pose(const Eigen::Vector3d& position, const Eigen::Quaterniond& turn) {
    Mat4 out;
    RowMajorPose matrix(out.data());
    matrix.setIdentity();
    matrix.topLeftCorner<3, 3>() = turn.toRotationMatrix();
    matrix.topRightCorner<3, 1>() = position;
    return out;
}

class TrajectoryParser {
  public:
    TrajectoryParser(const std::filesystem::path& file, std::string_view text)
        : file_(file), lines_(text) {}

    std::vector<Mat4> parse() {
        std::vector<Mat4> poses;
        std::vector<std::pair<std::uint64_t, std::uint64_t>> numbered;  // image, line
        std::string_view line;
        std::size_t columns = 0;
        while (next(line)) {
            if (columns == 0) columns = count(line);
            switch (columns) {
                case 8:
                    poses.push_back(tum(line));
                    break;
                case 12:
                    poses.push_back(kitti(line));
                    break;
                case 3:
                    numbered.emplace_back(image_number(line), lines_.number());
                    poses.push_back(matrix());
                    break;
                default:
                    bad("has " + counted(columns, "number") +
                        "; a pose is a line of 8 (t x y z qx qy qz qw), a line of 12 (three rows "
                        "[R | t]), or a line of 3 before a matrix of 4 lines");
            }
        }
        return columns == 3 ? by_image(poses, numbered) : poses;
    }

  private:
    [[noreturn]] void bad(const std::string& message) const { bad(lines_.number(), message); }
    [[noreturn]] void bad(std::uint64_t line, const std::string& message) const {
        fail(file_, "line " + std::to_string(line) + ": " + message);
    }

    // The next line that says something, without its comment.
    bool next(std::string_view& line) {
        while (lines_.next(line)) {
            line = line.substr(0, line.find('#'));
            auto rest = line;
            if (!next_token(rest).empty()) return true;
        }
        return false;
    }
    static std::size_t count(std::string_view line) {
        std::size_t tokens = 0;
        while (!next_token(line).empty()) ++tokens;
        return tokens;
    }

    // Exactly as many finite numbers as `values` holds.
    void numbers(std::string_view line, std::span<double> values, const char* names) const {
        const auto all = "the " + std::to_string(values.size()) + " numbers " + names;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const auto token = next_token(line);
            if (token.empty()) bad(std::to_string(i) + " of " + all);
            if (!parse_number(token, values[i]) || !std::isfinite(values[i]))
                bad(in_quotes(token) + " is not a finite number");
        }
        if (!next_token(line).empty()) bad("more than " + all);
    }
    Mat4 tum(std::string_view line) const {
        std::array<double, 8> v{};
        numbers(line, v, "t x y z qx qy qz qw");
        if (const auto fault = position_fault({v[1], v[2], v[3]})) bad(*fault);
        const double norm = std::hypot(std::hypot(v[4], v[5]), std::hypot(v[6], v[7]));
        if (!std::isfinite(norm) || norm < 1e-6) {
            bad("the quaternion has length " + short_number(norm) + " and gives no rotation");
        }
        return pose({v[1], v[2], v[3]}, {v[7] / norm, v[4] / norm, v[5] / norm, v[6] / norm});
    }

    Mat4 kitti(std::string_view line) const {
        Mat4 m{};
        numbers(line, std::span(m).first(12), "of three rows [R | t]");
        m[15] = 1;
        return rigid(m);
    }

    std::uint64_t image_number(std::string_view line) const {
        std::array<double, 3> v{};
        numbers(line, v, "that come before a pose's matrix, the first of them the image's");
        std::uint64_t number = 0;
        if (!parse_count(next_token(line), number))
            bad("the image's number must be whole, from 0 on, not " + short_number(v[0]));
        return number;
    }

    Mat4 matrix() {
        Mat4 m{};
        const auto first = lines_.number();
        for (std::size_t row = 0; row < 4; ++row) {
            std::string_view line;
            if (!next(line)) {
                bad(first, "the matrix after it has " + counted(row, "row") +
                               ", but a pose has 4; the file is cut short");
            }
            numbers(line, std::span(m).subspan(row * 4, 4), "of a row of the matrix");
        }
        return rigid(m);
    }

    Mat4 rigid(const Mat4& m) const {
        Mat4 out = m;
        if (const auto fault = make_rigid(out)) bad(*fault);
        return out;
    }

    // Poses that name their images, in the images' order.
    std::vector<Mat4> by_image(
        const std::vector<Mat4>& poses,
        const std::vector<std::pair<std::uint64_t, std::uint64_t>>& numbered) const {
        std::vector<Mat4> out(poses.size());
        std::vector<std::uint64_t> line_of(poses.size(), 0);
        for (std::size_t n = 0; n < poses.size(); ++n) {
            const auto [image, line] = numbered[n];
            if (image >= poses.size()) {
                bad(line, "is the pose of image " + std::to_string(image) + ", but the file has " +
                              counted(poses.size(), "pose") + ", so that images run from 0 to " +
                              std::to_string(poses.size() - 1));
            }
            if (line_of[image] != 0) {
                bad(line, "image " + std::to_string(image) + " has a pose already, in line " +
                              std::to_string(line_of[image]));
            }
            line_of[image] = line;
            out[image] = poses[n];
        }
        return out;
    }

    const std::filesystem::path& file_;
    Lines lines_;
};

}  // namespace

std::vector<Mat4> read_trajectory(const FileName& file) {
    const auto bytes = read_file(file);
    return TrajectoryParser(file.path(), bytes.text()).parse();
}

}  // namespace topple::io
