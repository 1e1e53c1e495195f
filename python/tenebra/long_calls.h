// Calls that take long run on a thread of their object's with Python's lock released, while the caller's
// thread wakes now and then to see whether Ctrl-C was pressed and to report progress.
#pragma once

#include <pybind11/functional.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <chrono>
#include <exception>
#include <optional>
#include <type_traits>
#include <utility>

#include <tenebra/queries.h>
#include <tenebra/threads.h>
#include "beside.h"
#include "loaded_scene.h"

namespace tenebra::python {

namespace py = pybind11;

using Report = std::optional<py::function>;  ///< gets the part that is done, 0 to 1

/// The value, or its failure as Python's ValueError.
template <class T>
T checked(Expected<T>&& result) {
  if (!result) throw py::value_error(result.error().message);
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

inline QueryProgress noted_in(Work& work) {
  return [&work](double done) { work.done = done; };
}

/// Runs body(work), which gives Expected<void>, beside Python: signals and `report` are seen to every 20 ms.
template <class Body>
void run_beside(Beside& beside, const Report& report, int threads, const Body& body) {
  Work work;
  std::exception_ptr interrupted;
  Expected<void> result;
  {
    const py::gil_scoped_release released;
    double said = 0;
    const auto job = [&] {
      Expected<void> out;
      with_threads(threads, [&] { out = body(work); });
      return out;
    };
    const auto meanwhile = [&] {
      if (interrupted) return;
      const py::gil_scoped_acquire acquired;
      try {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        const double done = work.done;
        if (report && done != said) (*report)(said = done);
      } catch (...) {
        interrupted = std::current_exception();
        work.stop.request();
      }
    };
    try {
      result = beside.run(job, std::chrono::milliseconds(20), meanwhile);
    } catch (...) {  // what the job threw: Ctrl-C goes before it
      if (!interrupted) throw;
    }
  }
  if (interrupted) std::rethrow_exception(interrupted);
  checked(std::move(result));
  if (report) (*report)(1.0);
}

}  // namespace tenebra::python
