#pragma once

#include <memory>
#include <new>

namespace doppel {

/// Owns a pointer from a C library, freed by `destroy`.
template <auto destroy>
struct Destroy {
    void operator()(auto* thing) const { destroy(thing); }
};
template <class T, auto destroy>
using Owned = std::unique_ptr<T, Destroy<destroy>>;

/// The same pointer, of a C library that returns null only when memory is exhausted: then throws std::bad_alloc.
template <class T>
T* checked(T* thing) {
    if (!thing) throw std::bad_alloc();
    return thing;
}

}  // namespace doppel
