# The Alvor server and its page. From the project's root: docker build -f docker/server.Dockerfile -t alvor-server .
# The same with Open MPI and ssh, for servers of several ranks (docs/cluster.md): docker build -f docker/server.Dockerfile --target ranks -t alvor-ranks .

# In another directory than the next stage: where two stages that are built at once begin alike, later builds find the steps of one of them only.
FROM debian:bookworm-slim AS page
WORKDIR /page
COPY scripts/setup.sh scripts/
RUN scripts/setup.sh page
COPY scripts/build_page.sh scripts/
COPY proto proto
COPY scenes scenes
COPY client/web client/web
RUN scripts/build_page.sh

FROM debian:bookworm-slim AS build
WORKDIR /alvor
COPY scripts/setup.sh scripts/
RUN scripts/setup.sh compile
COPY . .
# What is not needed is removed at once: some gigabytes that the layer would hold.
RUN CMAKE_OPTIONS=-DBUILD_TESTING=OFF scripts/build.sh alvor alvord alvor-import alvor-mpi && \
    cd build/release/bin && strip alvor alvord alvor-import alvor-mpi.so && \
    mkdir /built && cp alvor alvord alvor-import alvor-mpi.so /built && rm -rf /alvor/build

FROM debian:bookworm-slim AS server
RUN apt-get update -qq && \
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
      libassimp5 libembree3-3 libgrpc++1.51 libopenexr-3-1-30 libopenmesh1 libprometheus-cpp-pull1.0 libprotobuf32 libseccomp2 libspdlog1.10 \
      libsqlite3-0 libssl3 libtbb12 libwebp7 libzstd1 && \
    rm -rf /var/lib/apt/lists/* /var/cache/* /var/log/* && \
    echo 'alvor:x:10001:10001::/var/lib/alvor:/usr/sbin/nologin' >> /etc/passwd && echo 'alvor:x:10001:' >> /etc/group && \
    install -d -o 10001 -g 10001 -m 700 /var/lib/alvor && install -d -o 10001 -g 10001 -m 750 /run/alvor
COPY --from=page /page/build/release/bin/web /usr/local/share/alvor/web
COPY --from=build /built/alvord /built/alvor-import /usr/local/bin/
RUN alvord --help > /dev/null && alvor-import 10000000000 1 < /dev/null

# Each option has a variable of its name; what is given to the container's command goes before it.
ENV ALVORD_LISTEN=0.0.0.0:50051 ALVORD_DATA=/var/lib/alvor ALVORD_HEALTH=0.0.0.0:50052 ALVORD_PAGE=/usr/local/share/alvor/web
USER 10001:10001
VOLUME /var/lib/alvor
EXPOSE 50051 50052 8080 9464
HEALTHCHECK --interval=10s --timeout=5s --start-period=30s CMD ["alvord", "--probe", "127.0.0.1:50052"]
ENTRYPOINT ["alvord"]

# A host that waits for ranks. The one that starts them runs mpirun instead.
FROM server AS ranks
USER 0
RUN apt-get update -qq && \
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends libcairo2 openmpi-bin openssh-client openssh-server && \
    rm -rf /var/lib/apt/lists/* /var/cache/* /var/log/* /etc/ssh/ssh_host_* && \
    sed -i '/^alvor:/s:/usr/sbin/nologin:/bin/sh:' /etc/passwd
COPY --from=build /built/alvor /built/alvor-mpi.so /usr/local/bin/
COPY docker/ranks/sshd_config /etc/alvor/
COPY docker/ranks/ssh_config /etc/ssh/ssh_config.d/alvor.conf
COPY docker/ranks/openmpi-mca-params.conf /etc/openmpi/
USER 10001:10001
RUN mpirun -n 2 --oversubscribe alvor --version > /dev/null
EXPOSE 2222
ENTRYPOINT []
CMD ["/usr/sbin/sshd", "-D", "-e", "-f", "/etc/alvor/sshd_config"]

FROM server
