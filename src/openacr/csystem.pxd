cdef extern from *:
    """
    #if defined(__linux__)
    #include <errno.h>
    #include <poll.h>
    #include <sys/socket.h>
    #include <linux/if_packet.h>
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

    static long long frame_exchange(long long fd, unsigned char *out, long long size,
                                    unsigned char *back, long long room, long long place,
                                    long long until_ns)
    {
        struct sockaddr_ll from;
        struct pollfd wait = {(int)fd, POLLIN, 0};
        int late = 64;
        while (late-- > 0 && recv(wait.fd, back, room, MSG_DONTWAIT) >= 0)
            ;
        if (send(wait.fd, out, size, MSG_DONTWAIT) < 0)
            return 0;
        for (;;) {
            long long left = until_ns - now_ns();
            struct timespec rest = {left / 1000000000LL, left % 1000000000LL};
            socklen_t length = sizeof from;
            ssize_t got;
            if (left <= 0 || (ppoll(&wait, 1, &rest, 0) <= 0 && errno != EINTR))
                return 0;
            from.sll_family = AF_UNSPEC;
            got = recvfrom(wait.fd, back, room, MSG_DONTWAIT, (struct sockaddr *)&from, &length);
            if (got <= place || back[place] != out[place])
                continue;
            if (from.sll_family == AF_PACKET && from.sll_pkttype == PACKET_OUTGOING)
                continue;
            return got;
        }
    }
    #else
    static long long frame_exchange(long long fd, unsigned char *out, long long size,
                                    unsigned char *back, long long room, long long place,
                                    long long until_ns) { return 0; }
    static long long now_ns(void) { return 0; }
    static void wait_until_ns(long long due_ns) { (void)due_ns; }
    static void fence(void) { }
    #endif
    """
    long long frame_exchange(long long fd, unsigned char *out, long long size,
                             unsigned char *back, long long room, long long place,
                             long long until_ns) noexcept nogil
    long long now_ns() noexcept nogil
    void wait_until_ns(long long due_ns) noexcept nogil
    void fence() noexcept nogil
