// SPDX-License-Identifier: MIT
#include "mujoco/message.h"

#include <cstdint>

namespace topple::mujoco {
namespace {

template <class Visitor, class Of>
void settled_fields(Visitor& visit, Of& settled) {
    visit(settled.problem);
    visit(settled.cut_short);
    visit(settled.version);
    visit(settled.contacts);
    visit(settled.deepest_m);
    visit(settled.left_out);
    visit(settled.simulated_s);
    visit(settled.wall_s);
}

template <class Visitor, class Of>
void motion_fields(Visitor& visit, Of& motion) {
    visit(motion.body);
    visit(motion.moved_m);
    visit(motion.turned_deg);
    visit(motion.fastest_m_s);
}

}  // namespace

void write_settled(const Settled& settled) {
    child::Writer writer;
    settled_fields(writer, settled);
    writer(static_cast<std::uint64_t>(settled.motions.size()));
    for (const Motion& motion : settled.motions) motion_fields(writer, motion);
    writer.finish();
}

Settled read_settled(const child::Answer& answer) {
    child::Reader reader(answer);
    Settled out;
    settled_fields(reader, out);
    std::uint64_t motions = 0;
    reader(motions);
    for (std::uint64_t n = 0; n < motions; ++n) motion_fields(reader, out.motions.emplace_back());
    reader.finish();
    return out;
}

}  // namespace topple::mujoco
