// SPDX-License-Identifier: MIT
#pragma once

#include "graph/cut_chain.h"

namespace topple::test {

// Calls see(chain) after each of so many steps of a chain at one temperature.
template <class See>
void walk(const graph::CutProblem& problem, graph::EnergyCache& cache, topple::Random random,
          unsigned steps, double temperature, const See& see) {
    graph::CutChain chain(problem, cache, random);
    while (!chain.begin()) cache.evaluate(chain.wanted());
    for (unsigned step = 0; step < steps; ++step) {
        while (!chain.step([&](unsigned) { return temperature; })) cache.evaluate(chain.wanted());
        see(chain);
    }
}

}  // namespace topple::test
