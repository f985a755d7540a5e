// SPDX-License-Identifier: MIT
#include "mujoco/settled.h"

namespace topple::mujoco {
namespace {

template <class Io, class Of>
void settled_fields(Io& io, Of& settled) {
    io(settled.problem);
    io(settled.cut_short);
    io(settled.version);
    io(settled.contacts);
    io(settled.deepest_m);
    io(settled.left_out);
    io(settled.simulated_s);
    io(settled.wall_s);
    list_fields(io, settled.motions, [](auto& each, auto& motion) {
        each(motion.body);
        each(motion.moved_m);
        each(motion.turned_deg);
        each(motion.fastest_m_s);
    });
}

}  // namespace

void write_settled(const Settled& settled) {
    child::Writer writer;
    settled_fields(writer, settled);
    writer.finish();
}

Settled read_settled(const child::Answer& answer) {
    child::Reader reader(answer);
    Settled out;
    settled_fields(reader, out);
    reader.finish();
    return out;
}

}  // namespace topple::mujoco
