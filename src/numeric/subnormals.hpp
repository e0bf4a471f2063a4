#pragma once

namespace doppel {

/// During its lifetime, this thread treats doubles below 2.2e-308 as zero, as operands and as results. Processors are
/// up to a hundred times slower with such numbers, and a chain released at rest has many of them: the influence of one
/// end decreases along the chain without limit.
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
