# nginx in front of a server that faces strangers. From the project's root: docker build -f docker/front.Dockerfile -t alvor-front .
#
# Wants a certificate in /etc/alvor/tls (tls.crt, tls.key), alvord's sockets in /run/alvor, and /tmp to write to. Its group is alvord's, so that it
# may use the sockets; its user is another, so that it may not read what alvord keeps.

FROM debian:bookworm-slim
RUN apt-get update -qq && \
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends nginx-light && \
    rm -rf /var/lib/apt/lists/* /var/cache/* /var/log/* /etc/nginx/modules-enabled/* && \
    echo 'alvor:x:10001:' >> /etc/group && echo 'front:x:10002:10001::/nonexistent:/usr/sbin/nologin' >> /etc/passwd && \
    install -d -o 10001 -g 10001 -m 750 /run/alvor && install -d /etc/alvor/tls
COPY docker/nginx.conf /etc/alvor/nginx.conf

USER 10002:10001
EXPOSE 8443
STOPSIGNAL SIGQUIT
ENTRYPOINT ["nginx", "-e", "stderr", "-c", "/etc/alvor/nginx.conf", "-g", "daemon off;"]
