cdef extern from *:
    """
    #if defined(__linux__)
    #include <errno.h>
    #include <time.h>

    static long long now_ns(void)
    {
        struct timespec now;
        clock_gettime(CLOCK_MONOTONIC, &now);
        return now.tv_sec * 1000000000LL + now.tv_nsec;
    }

    static void wait_until_ns(long long due_ns)
    {
        struct timespec due;
        due.tv_sec = due_ns / 1000000000LL;
        due.tv_nsec = due_ns % 1000000000LL;
        while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, 0) == EINTR)
            ;
    }

    static void fence(void)
    {
        __atomic_thread_fence(__ATOMIC_SEQ_CST);
    }
    #else
    static long long now_ns(void) { return 0; }
    static void wait_until_ns(long long due_ns) { (void)due_ns; }
    static void fence(void) { }
    #endif
    """
    long long now_ns() noexcept nogil
    void wait_until_ns(long long due_ns) noexcept nogil
    void fence() noexcept nogil
