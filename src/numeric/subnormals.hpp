#pragma once

namespace doppel {

/// While it lives, this thread takes doubles below 2.2e-308 for zero, those that come out and those that go in. Processors
/// compute with them up to a hundred times as slowly, and a chain released at rest is full of them: what one end does
/// to the links far from it falls off without an end.
class NoSubnormals {
public:
    NoSubnormals() : before_(control()) { set_control(before_ | flush); }
    ~NoSubnormals() { set_control(before_); }
    NoSubnormals(const NoSubnormals&) = delete;
    NoSubnormals& operator=(const NoSubnormals&) = delete;

private:
#if defined(__x86_64__)
    static constexpr unsigned long flush = 0x8040;  // flush to zero, denormals are zeros
    static unsigned long control() {
        return __builtin_ia32_stmxcsr();
    }
    static void set_control(unsigned long value) {
        __builtin_ia32_ldmxcsr(static_cast<unsigned>(value));
    }
#elif defined(__aarch64__)
    static constexpr unsigned long flush = 1ul << 24;
    static unsigned long control() {
        unsigned long value;
        asm volatile("mrs %0, fpcr" : "=r"(value));
        return value;
    }
    static void set_control(unsigned long value) {
        asm volatile("msr fpcr, %0" : : "r"(value));
    }
#else
    static constexpr unsigned long flush = 0;
    static unsigned long control() {
        return 0;
    }
    static void set_control(unsigned long) {}
#endif

    unsigned long before_;
};

}  // namespace doppel
