#include <tenebra/queries.h>

#include "query/tracer_state.h"

namespace tenebra {

PointTracer::PointTracer() : state_(std::make_unique<query::TracerState>()) {}
PointTracer::PointTracer(PointTracer&&) noexcept = default;
PointTracer& PointTracer::operator=(PointTracer&&) noexcept = default;
PointTracer::~PointTracer() = default;

}  // namespace tenebra
