#include "gl/context.h"

#include <charconv>
#include <utility>

#include "base/fail.h"
#include "gl/backend.h"

namespace tenebra::gl {
namespace {

struct AdoptedBackend final : Context::Backend {
  explicit AdoptedBackend(FunctionLoader loader) : loader_(loader) {}
  bool make_current() override { return true; }
  FunctionLoader loader() const override { return loader_; }
  std::string_view kind_name() const override { return "window"; }

private:
  FunctionLoader loader_;
};

Expected<Context> finish(BackendResult made, ContextOptions options) {
  if (!made) return tl::unexpected(std::move(made.error()));
  Context::Backend& backend = **made;
  Context context(std::move(*made));
  if (auto current = context.make_current(); !current) return tl::unexpected(std::move(current.error()));
  if (options.debug) collect_debug_messages(backend);
  return context;
}

}  // namespace

std::optional<ContextChoice> context_choice_from_name(std::string_view name) {
  constexpr std::string_view device = "egl:";
  if (name == "auto") return ContextKind::automatic;
  if (name == "egl") return ContextKind::egl;
  if (name == "osmesa") return ContextKind::osmesa;
  if (!name.starts_with(device)) return std::nullopt;
  int number = 0;
  const char *const first = name.data() + device.size(), *const last = name.data() + name.size();
  const auto [end, error] = std::from_chars(first, last, number);
  if (error != std::errc() || end != last || *first == '-') return std::nullopt;
  return ContextChoice(ContextKind::egl, number);
}

Expected<Context> Context::create(ContextChoice choice, ContextOptions options) {
  if (choice.kind == ContextKind::egl) return finish(create_egl_backend(options, choice.device), options);
  if (choice.kind == ContextKind::osmesa) return finish(create_osmesa_backend(options), options);
  auto egl = finish(create_egl_backend(options, {}), options);
  if (egl) return egl;
  auto osmesa = finish(create_osmesa_backend(options), options);
  if (osmesa) return osmesa;
  return base::fail(ErrorKind::device, "no OpenGL context: {}; {}", egl.error().message,
                    osmesa.error().message);
}

Expected<Context> Context::adopt(FunctionLoader loader) {
  return finish(std::make_unique<AdoptedBackend>(loader), {});
}

Context::Context(std::unique_ptr<Backend> backend) : backend_(std::move(backend)) {}
Context::Context(Context&&) noexcept = default;
Context& Context::operator=(Context&&) noexcept = default;
Context::~Context() = default;

Expected<void> Context::make_current() {
  if (!backend_->make_current())
    return base::fail(ErrorKind::device, "OpenGL context {}: it cannot be made current", kind_name());
  return load_functions(*backend_);
}

bool Context::is_adopted() const {
  return kind_name() == "window";
}
std::string_view Context::kind_name() const {
  return backend_->kind_name();
}
const std::string& Context::description() const {
  return backend_->description;
}
FunctionLoader Context::function_loader() const {
  return backend_->loader();
}

std::vector<std::string> Context::take_debug_messages() {
  return std::exchange(backend_->debug_messages, {});
}

}  // namespace tenebra::gl
