// SPDX-License-Identifier: MIT
#include "simulation/simulation.h"

#include <LinearMath/btConvexHullComputer.h>
#include <btBulletDynamicsCommon.h>

#include <Eigen/Eigenvalues>

namespace topple::simulation {
namespace {

constexpr double margin_m = 1e-3, gravity = 9.80665;

btVector3 center_of(const Cell& cell, double voxel) {
    return {(cell[0] + 0.5) * voxel, (cell[1] + 0.5) * voxel, (cell[2] + 0.5) * voxel};
}

// Fixed cells as few boxes: runs along x, those alike joined along y, and those along z.
struct Block {
    Cell low{}, high{};
};
std::vector<Block> blocks_of(std::span<const Cell> cells) {
    std::vector<Block> blocks;
    for (const Cell& c : cells) blocks.push_back({c, {c[0] + 1, c[1] + 1, c[2] + 1}});
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // By all but this axis, then along it: what can be joined lies side by side.
        const auto key = [&](const Block& b) {
            const std::size_t p = (axis + 1) % 3, q = (axis + 2) % 3;
            return std::array{b.low[p], b.high[p], b.low[q], b.high[q]};
        };
        std::sort(blocks.begin(), blocks.end(), [&](const Block& a, const Block& b) {
            return key(a) != key(b) ? key(a) < key(b) : a.low[axis] < b.low[axis];
        });
        std::vector<Block> joined;
        for (const Block& b : blocks) {
            if (!joined.empty() && key(joined.back()) == key(b) &&
                joined.back().high[axis] == b.low[axis])
                joined.back().high[axis] = b.high[axis];
            else
                joined.push_back(b);
        }
        blocks = std::move(joined);
    }
    return blocks;
}

// Corners of a part's cells, about `origin`: of each row along z only the ends can be extreme.
std::vector<btVector3> corners(const std::vector<Cell>& part, double voxel,
                               const btVector3& origin) {
    std::map<std::array<std::int32_t, 2>, std::array<std::int32_t, 2>> rows;
    for (const Cell& c : part) {
        const auto [at, fresh] = rows.try_emplace({c[0], c[1]}, std::array{c[2], c[2] + 1});
        at->second = {std::min(at->second[0], c[2]), std::max(at->second[1], c[2] + 1)};
    }
    std::vector<btVector3> all;
    for (const auto& [column, ends] : rows) {
        for (int corner = 0; corner < 8; ++corner) {
            const btVector3 p(column[0] + (corner & 1), column[1] + (corner >> 1 & 1),
                              ends[corner >> 2 & 1]);
            all.push_back(p * voxel - origin);
        }
    }
    return all;
}

// The level on which most of the columns of a part rest, if any do: the height of what is fixed
// right below them, in cells. Of equals the highest.
std::optional<std::int32_t> level_under(const std::vector<Cell>& part,
                                        const std::set<Cell>& fixed) {
    std::map<std::array<std::int32_t, 2>, std::int32_t> lowest;
    for (const Cell& c : part) {
        const auto [at, fresh] = lowest.try_emplace({c[0], c[1]}, c[2]);
        at->second = std::min(at->second, c[2]);
    }
    std::map<std::int32_t, int> votes;
    for (const auto& [column, k] : lowest)
        if (fixed.contains({column[0], column[1], k - 1})) ++votes[k];
    std::optional<std::int32_t> level;
    for (const auto& [k, count] : votes)
        if (!level || count >= votes[*level]) level = k;
    return level;
}

// Whether a cell is in part on the inner side of all planes, by more than contact.
bool cuts(const std::vector<btVector3>& planes, const btVector3& center, double voxel) {
    return std::all_of(planes.begin(), planes.end(), [&](const btVector3& n) {
        const double half = voxel / 2 * (std::abs(n.x()) + std::abs(n.y()) + std::abs(n.z()));
        return n.dot(center) + n[3] - half < -0.05 * voxel;
    });
}

// Slower than this for a quarter of a second a body is at rest, even where it stood on an edge.
class Rest {
  public:
    bool reached(const btRigidBody& body, double step_s) {
        constexpr double still = 2e-3, rest_s = 0.25;
        const bool rests =
            body.getLinearVelocity().length() < still && body.getAngularVelocity().length() < still;
        resting_s_ = rests ? resting_s_ + step_s : 0;
        return resting_s_ >= rest_s;
    }

  private:
    double resting_s_ = 0;
};

struct Inertia {
    btTransform axes;  // principal, about the centre of mass
    btVector3 moments;
    double mass = 0;
};
Inertia inertia_of(const LooseBody& body) {
    btVector3 center(0, 0, 0);
    double count = 0;
    for (const auto& part : body.parts) {
        for (const Cell& c : part) center += center_of(c, body.voxel_m);
        count += static_cast<double>(part.size());
    }
    center /= count;
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // sum of x x'
    for (const auto& part : body.parts) {
        for (const Cell& c : part) {
            const btVector3 d = center_of(c, body.voxel_m) - center;
            const Eigen::Vector3d x(d.x(), d.y(), d.z());
            second += x * x.transpose();
        }
    }
    const double voxel2 = body.voxel_m * body.voxel_m;
    second += count * voxel2 / 12 * Eigen::Matrix3d::Identity();
    const double of_cell = body.density_kg_m3 * voxel2 * body.voxel_m;
    const Eigen::Matrix3d tensor =
        of_cell * (second.trace() * Eigen::Matrix3d::Identity() - second);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor);
    Eigen::Matrix3d axes = solver.eigenvectors();
    if (axes.determinant() < 0) axes.col(0) *= -1;
    const Eigen::Vector3d moments = solver.eigenvalues();
    Inertia result;
    result.axes.setBasis({axes(0, 0), axes(0, 1), axes(0, 2), axes(1, 0), axes(1, 1), axes(1, 2),
                          axes(2, 0), axes(2, 1), axes(2, 2)});
    result.axes.setOrigin(center);
    result.moments = {moments[0], moments[1], moments[2]};
    result.mass = of_cell * count;
    return result;
}

}  // namespace

LooseBody without_rough_underside(LooseBody body, std::span<const Cell> fixed) {
    const std::set<Cell> all_fixed(fixed.begin(), fixed.end());
    for (auto& part : body.parts) {
        const std::optional<std::int32_t> level = level_under(part, all_fixed);
        if (!level) continue;
        std::vector<Cell> above = part;
        std::erase_if(above, [&](const Cell& c) { return c[2] < *level; });
        if (2 * above.size() >= part.size()) part = std::move(above);
    }
    return body;
}

struct Simulation::World {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld dynamics{&dispatcher, &broadphase, &solver, &configuration};
    std::vector<std::unique_ptr<btCollisionShape>> shapes;
    btCompoundShape loose_shape, fixed_shape;
    std::unique_ptr<btRigidBody> loose, fixed;
    btTransform first;
    btVector3 origin{0, 0, 0};  // of the world: near the body, where numbers are small
    double mass = 0, height = 0;

    ~World() {
        dynamics.removeRigidBody(loose.get());
        dynamics.removeRigidBody(fixed.get());
    }

    // The hull of a part; its planes, outwards, are appended.
    void add_part(const std::vector<btVector3>& points,
                  std::vector<std::vector<btVector3>>& planes) {
        btConvexHullComputer computer;
        // Bullet rounds shapes off by their margin outwards: without it the hull has its own size.
        computer.compute(points.front().m_floats, sizeof(btVector3),
                         static_cast<int>(points.size()), margin_m, 0);
        auto hull = std::make_unique<btConvexHullShape>();
        for (int n = 0; n < computer.vertices.size(); ++n)
            hull->addPoint(first.inverse() * computer.vertices[n], false);
        hull->recalcLocalAabb();
        hull->setMargin(margin_m);
        loose_shape.addChildShape(btTransform::getIdentity(), hull.get());
        shapes.push_back(std::move(hull));
        planes.emplace_back();
        for (int f = 0; f < computer.faces.size(); ++f) {
            const auto* edge = &computer.edges[computer.faces[f]];
            const btVector3 a = computer.vertices[edge->getSourceVertex()],
                            b = computer.vertices[edge->getTargetVertex()];
            const auto* next = edge->getNextEdgeOfFace();
            btVector3 normal(0, 0, 0);
            for (; next != edge; next = next->getNextEdgeOfFace())
                normal += (b - a).cross(computer.vertices[next->getTargetVertex()] - a);
            normal.normalize();
            normal[3] = -normal.dot(a) - margin_m;
            planes.back().push_back(normal);
        }
        for (const btVector3& p : points) height = std::max(height, p.z());
    }

    void add_body(btRigidBody& body, double friction) {
        body.setFriction(friction);
        body.setRestitution(0);
        body.setActivationState(DISABLE_DEACTIVATION);
        dynamics.addRigidBody(&body);
    }
};

Simulation::Simulation(const LooseBody& body, std::span<const Cell> fixed, double friction,
                       double step_s)
    : world_(std::make_unique<World>()), step_s_(step_s) {
    World& w = *world_;
    const Inertia inertia = inertia_of(body);
    w.origin = inertia.axes.getOrigin();
    w.first = inertia.axes;
    w.first.setOrigin({0, 0, 0});
    w.mass = inertia.mass;
    std::vector<std::vector<btVector3>> planes;
    for (const auto& part : body.parts) w.add_part(corners(part, body.voxel_m, w.origin), planes);

    std::vector<Cell> around;
    for (const Cell& cell : fixed) {
        const btVector3 p = center_of(cell, body.voxel_m) - w.origin;
        const bool cut = std::any_of(planes.begin(), planes.end(),
                                     [&](const auto& hull) { return cuts(hull, p, body.voxel_m); });
        if (!cut) around.push_back(cell);
    }
    for (const Block& b : blocks_of(around)) {
        const btVector3 low(b.low[0], b.low[1], b.low[2]), high(b.high[0], b.high[1], b.high[2]);
        auto box = std::make_unique<btBoxShape>((high - low) * (body.voxel_m / 2));
        box->setMargin(margin_m);
        btTransform at = btTransform::getIdentity();
        at.setOrigin((low + high) * (body.voxel_m / 2) - w.origin);
        w.fixed_shape.addChildShape(at, box.get());
        w.shapes.push_back(std::move(box));
    }
    w.dynamics.setGravity({0, 0, -gravity});
    // What overlaps by a part of a voxel is moved apart without being given speed.
    w.dynamics.getSolverInfo().m_splitImpulse = 1;
    w.dynamics.getSolverInfo().m_splitImpulsePenetrationThreshold = 0;
    w.dynamics.getSolverInfo().m_numIterations = 50;
    w.fixed = std::make_unique<btRigidBody>(0, nullptr, &w.fixed_shape);
    w.loose = std::make_unique<btRigidBody>(inertia.mass, nullptr, &w.loose_shape, inertia.moments);
    w.loose->setWorldTransform(w.first);
    // Bullet takes the product of two bodies' coefficients.
    w.add_body(*w.fixed, 1);
    w.add_body(*w.loose, friction);
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;

double Simulation::mass_kg() const {
    return world_->mass;
}

double Simulation::height_m() const {
    return world_->height;
}

void Simulation::push(const Vec3& impulse_Ns, const Vec3& at_m) {
    world_->loose->applyImpulse({impulse_Ns[0], impulse_Ns[1], impulse_Ns[2]},
                                {at_m[0], at_m[1], at_m[2]});
}

double Simulation::energy_J(const Vec3& impulse_Ns, const Vec3& at_m) const {
    const btVector3 p(impulse_Ns[0], impulse_Ns[1], impulse_Ns[2]), r(at_m[0], at_m[1], at_m[2]);
    const btVector3 spin = r.cross(p);
    return 0.5 * (p.length2() / world_->mass +
                  spin.dot(world_->loose->getInvInertiaTensorWorld() * spin));
}

void Simulation::run(double seconds, double far_m) {
    const auto& at = world_->loose->getCenterOfMassPosition();
    for (double t = 0; t < seconds && at.length() <= far_m; t += step_s_)
        world_->dynamics.stepSimulation(step_s_, 0);
}

bool Simulation::sinks(double seconds, double by_m) {
    const btRigidBody& body = *world_->loose;
    Rest rest;
    for (double t = 0; t < seconds && !rest.reached(body, step_s_); t += step_s_) {
        world_->dynamics.stepSimulation(step_s_, 0);
        if (body.getCenterOfMassPosition().z() < -by_m) return true;
    }
    return false;
}

bool Simulation::falls(double seconds, double by_m, double far_m, const Load& load) {
    btRigidBody& body = *world_->loose;
    const btTransform start = body.getCenterOfMassTransform();
    const btVector3 at =
        start.getBasis().transpose() * btVector3(load.at_m[0], load.at_m[1], load.at_m[2]);
    const btVector3 force(load.force_N[0], load.force_N[1], load.force_N[2]);
    bool fell = false;
    Rest rest;
    for (double t = 0; t < seconds && !fell; t += step_s_) {
        if (!load.thrown_m_s2 && rest.reached(body, step_s_)) break;
        const Vec3 thrown = load.thrown_m_s2 ? load.thrown_m_s2(t) : Vec3{};
        body.setGravity({thrown[0], thrown[1], thrown[2] - gravity});
        body.applyForce(force, body.getWorldTransform().getBasis() * at);
        world_->dynamics.stepSimulation(step_s_, 0);
        const btVector3& p = body.getCenterOfMassPosition();
        fell = p.z() < -by_m;
        if (std::hypot(p.x(), p.y()) > far_m) break;
    }
    body.setGravity({0, 0, -gravity});
    return fell;
}

void Simulation::reset() {
    World& w = *world_;
    w.loose->setWorldTransform(w.first);
    w.loose->setInterpolationWorldTransform(w.first);
    w.loose->setLinearVelocity({0, 0, 0});
    w.loose->setAngularVelocity({0, 0, 0});
    w.loose->clearForces();
    // What the contacts of the last step pressed would start the next one.
    w.broadphase.getOverlappingPairCache()->cleanProxyFromPairs(w.loose->getBroadphaseProxy(),
                                                                &w.dispatcher);
    w.solver.reset();
}

Vec3 Simulation::moved_m() const {
    const btVector3& p = world_->loose->getCenterOfMassPosition();
    return {p.x(), p.y(), p.z()};
}

}  // namespace topple::simulation
